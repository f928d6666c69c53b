"""Objects of a Structured Text project, as text and as PLCopenXML.

It may import no other folder of `emit`.

declaration: the content of a declaration, read from its text
document: PLCopenXML as CODESYS reads it
interface: the elements of PLCopenXML for a declaration: sections, variables, types, pragmas
objects: the objects of a text as CODESYS holds them, each with declaration and implementation
"""
