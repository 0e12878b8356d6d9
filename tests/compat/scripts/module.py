"""RFModule and ResourceFinder."""

import threading
import time

import yarp

yarp.Network.init()
yarp.Network.setLocalMode(True)


notes = []


class Module(yarp.RFModule):
    def __init__(self, note):
        yarp.RFModule.__init__(self)
        self.note = note
        self.count = 0

    def configure(self, rf):
        print("configure", self.note, rf.check("name"), rf.find("name").asString())
        self.rpc = yarp.Port()
        self.rpc.open("/m/rpc")
        self.attach(self.rpc)
        return True

    def getPeriod(self):
        return 0.02

    def updateModule(self):
        self.count += 1
        return True

    def respond(self, command, reply):
        word = command.get(0).asString()
        if word == "hello":
            reply.addString("world")
            return True
        if word == "filled":
            reply.addString("filled")
        return False

    def interruptModule(self):
        notes.append(("interrupt", self.count > 0))
        return True

    def close(self):
        notes.append("close")
        self.rpc.close()
        return True


rf = yarp.ResourceFinder()
print(rf.isConfigured(), rf.check("name"), rf.find("name").isNull())
print(rf.setVerbose(True), rf.setDefaultContext("lab"), rf.setDefaultConfigFile("none.ini"))
print(rf.setDefault("rate", 5), rf.setDefault("word", "w"), rf.setDefault("half", 0.5))
line = ["program", "--name", "/mm", "--list", "(1 2)", "--flag", "--number", "-3.5", "--rate", "6"]
print(rf.configure(line), rf.isConfigured())
print(rf.find("list").asList().size(), rf.check("flag"), rf.find("number").asFloat64())
print(rf.find("rate").asInt32(), rf.find("word").asString(), rf.find("half").asFloat64())
print(rf.findGroup("list").toString(), rf.check("none", yarp.Value(7)).asInt32())
print(repr(rf.findFile("nothing.txt")), repr(rf.findFileByName("nothing.txt")), rf.getContext())
print(rf.find("none").asString() == "", rf.findGroup("none").isNull())

module = Module("a note")
codes = []
thread = threading.Thread(target=lambda: codes.append(module.runModule(rf)))
thread.start()
for _ in range(1000):
    if module.count and yarp.Network.exists("/m/rpc"):  # in C++ not while the port is opened
        break
    time.sleep(0.01)
client = yarp.RpcClient()
client.open("/cc")
print(client.addOutput("/m/rpc"))
for word in ("hello", "help", "filled", "quit"):
    reply = yarp.Bottle()
    print(word, client.write(yarp.Bottle(word), reply), reply.toString())
thread.join(10)
print(notes, codes, thread.is_alive(), module.isStopping())
client.close()


class Refusing(yarp.RFModule):
    def configure(self, rf):
        return False


print(Refusing().runModule(rf))
