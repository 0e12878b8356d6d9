"""ROS 2 messages and services: from the text of a `.msg` file to the classes of `idl/rosmsg`, with
the type hash and the bytes of ROS 2.

    parse                      texts, where they differ from those of ROS 1
    hash                       RIHS01, by which types are told apart
    cdr_reader, cdr_writer     the bytes: CDR, little-endian
    cdr_plain                  others of CDR to these
    library, source            types by name, and where their texts come from

Rules: values are objects as those of ROS 1 are, and become values of YARP in the same way
(`ros/message/convert/native.py`). Definitions and bytes may come from strangers; whatever they ask
for has a limit.
"""
