"""Proofs on real controllers: what is generated is built, loaded and moved by the controller's own programs."""
