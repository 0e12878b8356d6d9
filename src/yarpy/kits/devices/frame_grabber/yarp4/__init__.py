"""The ports of YARP 4.0 that answer functions of Thrift; the files beside this folder speak YARP 3.

functions          what can be asked; `functions.thrift` says it to other languages
table              what each function means
server, requests   answer and ask them
"""
