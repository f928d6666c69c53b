"""What is told about a mechanism: reasons of a refusal, costs, reference calls for a test on the controller."""
