"""Which step of the derivation a branch is: of those that a description names, of others, and of assembly modes."""
