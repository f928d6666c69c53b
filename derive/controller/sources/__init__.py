"""Where axis values come from. Each source reads, and writes nothing to a controller.

Like `controller`, it may import the folders from `ir` to `view`.

certificates: how the certificate of a controller is checked, for TLS
data_layer: the data layer of a ctrlX, by its REST interface
lines: standard input, line by line
opc_ua: OPC UA: all nodes in one request
opc_ua_trust: the certificate of this client, and why that of a server is trusted
pace: so many times a second
table: a CSV file, replayed
"""
