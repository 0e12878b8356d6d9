"""Questions and answers: RpcServer and RpcClient, ports that ask, PortReader."""

import threading
import time

import yarp

yarp.Network.init()
yarp.Network.setLocalMode(True)
server = yarp.RpcServer()
client = yarp.RpcClient()
print(server.open("/s"), client.open("/c"))
reply = yarp.Bottle("old")
print("unconnected", client.write(yarp.Bottle("hi"), reply), reply.toString())
print(client.addOutput("/s"), client.addOutput("/nn"), client.getOutputCount())
for _ in range(1000):
    if server.getInputCount():
        break
    time.sleep(0.01)
print(server.getInputCount())
said = []


def serve():
    command = yarp.Bottle()
    said.append(("got", server.read(command, True), command.toString()))
    answer = yarp.Bottle("ok")
    answer.append(command)
    said.append(("reply", server.reply(answer)))
    said.append(("got", server.read(command), command.toString()))
    said.append(("drop", server.replyAndDrop(yarp.Bottle("x"))))


thread = threading.Thread(target=serve)
thread.start()
for i in range(2):
    print(i, client.write(yarp.Bottle("hi %d" % i), reply), reply.toString())
thread.join(5)
print(said)
time.sleep(0.3)
client.close()
server.close()


class Reader(yarp.PortReader):
    def read(self, connection):
        command = yarp.Bottle()
        if not command.read(connection):
            return False
        writer = connection.getWriter()
        print("reader got", command.toString(), writer is not None)
        if writer is not None:
            answer = yarp.Bottle("re")
            answer.append(command)
            answer.write(writer)
        return True


reader = Reader()
asked = yarp.Port()
asked.setReader(reader)
asked.open("/asked")
asker = yarp.Port()
asker.open("/asker")
print("nobody", asker.write(yarp.Bottle("x"), reply))
print(yarp.Network.connect("/asker", "/asked"))
print(asker.write(yarp.Bottle("x y")), asker.write(yarp.Bottle("z"), reply), reply.toString())
asker.close()
asked.close()


class Last(yarp.PortReader):
    def read(self, connection):
        print("told", connection.isValid(), connection.getWriter(), yarp.Bottle().read(connection))
        return False


for kind in (yarp.Port, yarp.RpcServer):
    told, last = kind(), Last()
    told.setReader(last)
    told.close()
    print(kind.__name__, told.open("/told"))
    told.interrupt()
    print("interrupted")
    told.resume()
    told.close()
    print("closed")
    told.close()
