"""ResourceFinder: options, files that are there and files that are not."""

import os
import tempfile

import yarp

folder = os.path.realpath(tempfile.mkdtemp())
os.chdir(folder)
with open("x.ini", "w", encoding="utf-8") as file:
    file.write('a 1\nb 2.5\nname "hello world"\n[g]\nc 3\nlist (1 2 3)\n[h]\n')
os.mkdir("sub")
with open("sub/y.ini", "w", encoding="utf-8") as file:
    file.write("q 2\n")


def made(arguments, file="", context="", **defaults):
    rf = yarp.ResourceFinder()
    if context:
        rf.setDefaultContext(context)
    if file:
        rf.setDefaultConfigFile(file)
    for key, value in defaults.items():
        rf.setDefault(key, value)
    print(rf.configure(["program", *arguments]), rf.isConfigured(), rf.check("from"))
    return rf


def place(path):
    return path.replace(folder, "HERE")


rf = made(["--from", folder + "/x.ini", "--b", "7", "--flag"], "x.ini")
print(rf.find("a").asInt32(), rf.find("b").asInt32(), rf.check("flag"), rf.check("none"))
print(rf.find("name").asString(), rf.check("none", "what"), place(rf.find("from").asString()))
print(rf.check("none", yarp.Value(4)).asInt32(), rf.check("a", yarp.Value(4)).asInt32())
g = rf.findGroup("g")
print(g.toString(), g.find("c").asInt32(), g.check("list"), rf.findGroup("none").isNull())
print(rf.findGroup("h").toString())
for name in ("x.ini", "sub/y.ini", "none"):
    print(name, place(rf.findFile(name)), place(rf.findFileByName(name)), place(rf.findPath(name)))
print(place(rf.findPath()), place(rf.findPath("sub")))

rf = made(["--from", folder + "/sub/y.ini"])
print(rf.find("q").asInt32(), place(rf.findFile("y.ini")), place(rf.findFile("x.ini")))
rf = made(["--name", "/z"], "nowhere.ini")
print(rf.find("name").asString(), rf.find("from").asString())
rf = made(["--name", "/z", "--from", "nowhere.ini"], "x.ini", "no_such_context")
print(rf.find("name").asString(), rf.find("from").asString(), rf.getContext(), rf.check("a"))
rf = made([], "x.ini", a="9")
print(rf.find("a").asInt32(), rf.find("from").asString())
rf = made(["--a", "5"], "x.ini")
print(rf.find("a").asInt32())
rf = made(["--name", "/z"], name="n", v=1.5)
print(rf.find("name").asString(), rf.find("v").asFloat64())
rf = made(["--a"])
print(rf.check("a"), rf.find("a").isNull(), repr(rf.find("a").toString()))
rf = made(["word", "--a", "(1 2)", "--b", "x y", "--c", "-3", "--d", "1", "2"])
print(rf.find("a").asList().size(), rf.find("b").asString(), rf.find("c").asInt32())
print(rf.findGroup("d").toString(), rf.check("word"))
