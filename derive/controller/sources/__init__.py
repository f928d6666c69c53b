"""The sources of axis values. Each source only reads from a controller, and never writes.

Like `controller`, it may import the folders from `ir` to `view`.

data_layer: the data layer of a ctrlX, by its REST interface
lines: standard input, line by line
opc_ua: OPC UA: all nodes in one request
opc_ua_trust: the certificate of this client, and the trust in that of a server
pace: a constant rate
table: a CSV file, replayed
"""
