"""ROS 2 over Zenoh, as rmw_zenoh_cpp speaks it.

participant, graph, listing     our part in a domain, and who else is there
token, attachment               who somebody is, and what stands beside each message
endpoint                        what ports publish, hear, ask and serve
topic, service                  the same for nodes of a program
description                     what a type looks like that nobody here knows
"""
