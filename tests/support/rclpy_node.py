"""A node of ROS 2 itself, by rclpy, which does what the lines of its input say, each a JSON list.

python rclpy_node.py NAME

    ["publish", TOPIC, PROFILE]          a publisher of texts; PROFILE is one of those below
    ["say", TOPIC, TEXT]                 ... publishes one
    ["hear", TOPIC, PROFILE]             prints ["heard", TOPIC, TEXT] for what comes
    ["serve", NAME]                      answers SetBool with the opposite
    ["echo", KIND, FROM, TO]             sends on what comes of a type
    ["nodes"]                            names of nodes
    ["topics", NODE, NAMESPACE]          topics that a node publishes, with their types
    ["services", NODE, NAMESPACE]        services that a node has, with their types
    ["publishers_of", TOPIC]             [node, type, hash, reliability, durability] of each

Each is answered by ["done", VERB, ...].
"""

import json
import sys
import threading
from importlib import import_module

import rclpy
from rclpy.executors import ExternalShutdownException, SingleThreadedExecutor
from rclpy.qos import (
    DurabilityPolicy,
    QoSProfile,
    ReliabilityPolicy,
    qos_profile_sensor_data,
)
from std_msgs.msg import String
from std_srvs.srv import SetBool

PROFILES = {
    "default": QoSProfile(depth=100),
    "sensor": qos_profile_sensor_data,
    "latched": QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL),
    "kept": QoSProfile(depth=100, durability=DurabilityPolicy.TRANSIENT_LOCAL),
    "echo": QoSProfile(  # of `ros2 topic echo --qos-durability transient_local` alone
        depth=5,
        durability=DurabilityPolicy.TRANSIENT_LOCAL,
        reliability=ReliabilityPolicy.BEST_EFFORT,
    ),
}


def tell(*words):
    print(json.dumps(words), flush=True)


class Obeys:
    def __init__(self, name):
        self.node = rclpy.create_node(name)
        self.publishers = {}
        self.kept = []

    def publish(self, topic, profile):
        self.publishers[topic] = self.node.create_publisher(String, topic, PROFILES[profile])

    def say(self, topic, text):
        self.publishers[topic].publish(String(data=text))

    def hear(self, topic, profile):
        def heard(message):
            tell("heard", topic, message.data)

        self.kept.append(self.node.create_subscription(String, topic, heard, PROFILES[profile]))

    def serve(self, name):
        def answer(request, response):
            response.success, response.message = not request.data, "by rclpy"
            return response

        self.kept.append(self.node.create_service(SetBool, name, answer))

    def echo(self, kind, source, target):
        package, _, name = kind.split("/")
        made = getattr(import_module(f"{package}.msg"), name)
        out = self.node.create_publisher(made, target, PROFILES["default"])
        heard = self.node.create_subscription(made, source, out.publish, PROFILES["default"])
        self.kept += [out, heard]

    def nodes(self):
        found = self.node.get_node_names_and_namespaces()
        return [f"{space.rstrip('/')}/{name}" for name, space in found]

    def topics(self, name, space):
        return self.node.get_publisher_names_and_types_by_node(name, space)

    def services(self, name, space):
        return self.node.get_service_names_and_types_by_node(name, space)

    def publishers_of(self, topic):
        return [
            [
                f"{one.node_namespace.rstrip('/')}/{one.node_name}",
                one.topic_type,
                str(one.topic_type_hash),
                one.qos_profile.reliability.name,
                one.qos_profile.durability.name,
            ]
            for one in self.node.get_publishers_info_by_topic(topic)
        ]


def main():
    rclpy.init(args=[])
    obeys = Obeys(sys.argv[1])
    executor = SingleThreadedExecutor()
    executor.add_node(obeys.node)

    def spin():
        try:
            executor.spin()
        except ExternalShutdownException:
            pass

    threading.Thread(target=spin, daemon=True).start()
    tell("ready")
    for line in sys.stdin:
        verb, *words = json.loads(line)
        tell("done", verb, getattr(obeys, verb)(*words))


if __name__ == "__main__":
    main()
