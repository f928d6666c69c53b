"""Objects of a Structured Text project, as text and as PLCopenXML."""
