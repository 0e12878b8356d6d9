"""ROS 1 messages: from the text of a `.msg` file to Python objects and bytes.

    parse, definition              texts to types, with the checksum of ROS
    source, catalogue, standard    where texts come from, and types by name
    library, factory, message      the Python class of a type
    reader, writer, code, fault    the bytes of ROS, and what does not fit
    bottle, wire                   the same as Bottles, and on YARP's own connections
    native, picture, cloud         YARP's own types as messages, and back
    show, stub, template, sniff    texts: for people, editors and C++ YARP, of what a port sends

Rules: definitions and bytes may come from strangers; whatever they ask for has a limit.
"""
