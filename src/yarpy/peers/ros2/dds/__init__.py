"""ROS 2 over DDS, by the library cyclonedds.

library, raw, qos            the library, and its words for types and QoS
participant, pump            our part in a domain, and the thread that waits for what comes
discovery                    which nodes there are, and whose an endpoint is
endpoint                     what ports publish and hear
pair, service                services, for ports and nodes
topic, rmw                   topics for nodes, and all that a node has
"""
