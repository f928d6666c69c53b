"""Reports on a mechanism: reasons of refusals, costs, and reference calls for the self-test on the controller."""
