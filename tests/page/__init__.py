"""The pages of machines, read as a person reads them: their formulas are evaluated from the MathML alone."""
