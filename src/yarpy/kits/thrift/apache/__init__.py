"""Thrift as Apache's libraries speak it: TBinaryProtocol and TCompactProtocol, for clients and
servers of any language.

Rules: `binary` and `compact` read and write bytes, `encode` and `decode` values of kinds by either,
`carrier` is the connection, `serve` answers with a service, `client` asks. Nothing else in the kit
knows these protocols, but that a service is asked by them, too.
"""
