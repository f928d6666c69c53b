"""The emitted Structured Text against the SoftMotion contract and the rules of its layout."""
