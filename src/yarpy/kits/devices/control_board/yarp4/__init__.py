"""The ports of YARP 4.0 that answer functions of Thrift; the files beside this folder speak YARP 3.

functions.thrift   what can be asked; `functions.py` is written from it by `yarpy idl thrift`
table              what each function means
server, requests   answer and ask them
"""
