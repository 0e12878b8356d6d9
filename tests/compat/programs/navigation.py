"""Serves a simulated robot, and sends it somewhere through the clients of navigation."""

import yarp

yarp.Network.init()


def opened(text):
    driver = yarp.PolyDriver()
    options = yarp.Property()
    options.fromString(text)
    if not driver.open(options):
        raise SystemExit(text)
    return driver


base, storage = opened("(device fakeNavigation)"), opened("(device map2DStorage)")
servers = []
for device, name, inner in (
    ("navigation2D_nws_yarp", "/nav", base),
    ("localization2D_nws_yarp", "/where", base),
    ("map2D_nws_yarp", "/maps/rpc", storage),
):
    server = opened(f"(device {device}) (name {name})")
    print(device, server.attach(inner))
    servers.append(server)

client = opened(
    "(device navigation2D_nwc_yarp) (local /script) (navigation_server /nav) "
    "(map_locations_server /maps) (localization_server /where)"
)
nav = client.viewINavigation2D()
print("store", nav.storeLocation("sink", yarp.Map2DLocation("map", 2.0, 1.0, 90.0)))
place = yarp.Map2DLocation()
print("get", nav.getLocation("sink", place), place.toString())
names = yarp.SVector()
print("list", nav.getLocationsList(names), [*names], [*nav.getLocationsList()])
corners = yarp.Map2DLocationVector(
    [yarp.Map2DLocation("map", x, y, 0.0) for x, y in ((0, 0), (3, 0), (3, 3))]
)
area = yarp.Map2DArea("map", corners, "corner")
print("area", nav.storeArea("a", area), area.checkLocationInsideArea(place))
found = yarp.Map2DArea()
print("area", nav.getArea("a", found), found.points[1], nav.getArea("b", found))
path = yarp.Map2DPath(corners)
print("path", nav.storePath("p", path), path.getLength(), path.size())
print("go", nav.gotoTargetByLocationName("sink"), nav.getNavigationStatus() == yarp.encode("movg"))
target = nav.getAbsoluteLocationOfCurrentTarget()
print("target", target.x, target.y, nav.suspendNavigation(), nav.stopNavigation())
print("velocity", nav.applyVelocityCommand(0.1, 0.0, 5.0, 0.1), nav.followPath(path))
one, two, three = yarp.DVector(1), yarp.DVector(1), yarp.DVector(1)
print("last", nav.getLastVelocityCommand(one, two, three), one[0], three[0])
print("here", nav.setInitialPose(place), nav.getCurrentPosition(place, yarp.Matrix(3, 3)))
print("poses", len(nav.getEstimatedPoses()), nav.stopLocalizationService())
print("status", nav.getLocalizationStatus() == yarp.encode("locn"), nav.getCurrentPosition().x)
print("none", client.viewILLM(), nav.storeCurrentPosition("here"))

model = opened("(device fakeLLMDevice)")
llm = model.viewILLM()
answer = yarp.LLM_Message()
print("ask", llm.setPrompt("be short"), llm.ask("Hello", answer), answer.content)
lines = yarp.LLMVector()
prompt = yarp.SVector(1)
print("lines", llm.getConversation(lines), len(lines), llm.readPrompt(prompt), prompt[0])

world = opened("(device fakeSimulatedWorld)").viewISimulatedWorld()
print("ball", world.makeSphere("ball", 0.1, yarp.Pose6D(1.0, 2.0), yarp.ColorRGB(255, 0, 0)))
print("world", [*world.getList()], world.getPose("ball").y, world.getPose("box").y)

source, pack = (
    opened("(device battery_nws_yarp) (name /pack) (period 0.05)"),
    opened("(device fakeBattery)"),
)
print("battery", source.attach(pack))
battery = opened("(device battery_nwc_yarp) (remote /pack)")
view = battery.viewIBattery()
print("charge", view.getBatteryCharge() > 90, view.getBatteryStatus(), view.getBatteryInfo())
store = opened("(device frameTransformServer)")
frames = opened("(device frameTransformClient)")
where = frames.viewIFrameTransform()
pose, found = yarp.Matrix(4, 4), yarp.Matrix(4, 4)
pose.eye()
pose.set(0, 3, 1.5)
print("place", where.setTransformStatic("hand", "base", pose), where.getParent("hand"))
print("pose", where.getTransform("hand", "base", found), found.get(0, 3), found.get(1, 1))
for axes in ((1, -1, -1), (-1, 1, -1), (-1, -1, 1)):  # half a turn around x, y, z
    for at, value in enumerate(axes):
        pose.set(at, at, value)
    where.setTransformStatic("foot", "base", pose)
    where.getTransform("foot", "base", found)
    print("turn", [round(found.get(at, at)) for at in range(3)] == [*axes])
    where.deleteTransform("foot", "base")
print("frames", where.frameExists("hand"), where.canTransform("foot", "base"))
print("sorted", sorted(where.getAllFrameIds()), where.clear())
for driver in (battery, source, frames, store, client, *servers):
    driver.close()
