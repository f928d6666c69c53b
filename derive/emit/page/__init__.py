"""The page of a machine: its derivation in HTML with MathML, to be read on a screen and on paper."""
