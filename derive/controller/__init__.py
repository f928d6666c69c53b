"""Axis values of a controller, live, for the page that draws the machine: sources, the protocol, the server."""
