"""Images: their sizes, pixels, foreign memory, copies, over ports."""

import threading

import yarp

rgb = yarp.ImageRgb()
print(rgb.width(), rgb.height())
rgb.resize(4, 3)
print(rgb.getRawImageSize(), rgb.getQuantum(), rgb.getPixelSize(), rgb.getPixelCode())
print(rgb.getRowSize(), rgb.getPadding(), rgb.topIsLowIndex())
rgb.zero()
print(rgb.pixel(1, 1).r)
rgb.pixel(1, 1).r = 200
rgb.pixel(1, 1).b = 100
print(rgb.pixel(1, 1).r, rgb.pixel(1, 1).g, rgb.pixel(1, 1).b)
print(rgb.isPixel(4, 0), rgb.isPixel(3, 2), rgb.safePixel(9, 9).r, int(rgb.getRawImage()) > 0)
mono = yarp.ImageMono()
mono.resize(5, 2)
print(mono.getRawImageSize(), mono.copy(rgb), mono.width(), mono.height(), mono.getRawImageSize())
back = yarp.ImageRgb()
print(back.copy(mono), back.pixel(1, 1).r, back.pixel(1, 1).g)
floats = yarp.ImageFloat()
print(floats.copy(rgb), floats.getRawImageSize(), floats.width())
for kind in ("Mono", "Mono16", "Int", "Float", "Rgb", "Rgba", "RgbFloat"):
    print(kind, getattr(yarp, "Image" + kind)().getPixelCode())
print(yarp.FlexImage().getPixelCode())

memory = bytearray(range(27))
outer = yarp.ImageRgb()
outer.setExternal(memoryview(memory), 3, 3)
print(outer.pixel(2, 2).b, outer.getQuantum(), outer.getRawImageSize(), outer.width())
outer.pixel(0, 0).r = 99
print(memory[0])
own = yarp.ImageRgb()
print(own.copy(outer), own.getQuantum(), own.getRawImageSize(), own.pixel(2, 2).b)
own.pixel(1, 1).g = 77
rgb.setQuantum(1)
rgb.resize(3, 2)
print(rgb.getRawImageSize())

yarp.Network.init()
yarp.Network.setLocalMode(True)
out, inp = yarp.Port(), yarp.Port()
inp.open("/in")
out.open("/out")
yarp.Network.connect("/out", "/in")


def passed(written, read):
    writer = threading.Thread(target=out.write, args=(written,))
    writer.start()
    done = inp.read(read)
    writer.join()
    return done


got = yarp.ImageRgb()
print(passed(own, got), got.width(), got.height(), got.pixel(1, 1).g, got.pixel(2, 2).b)
grey = yarp.ImageMono()
print(passed(own, grey), grey.width(), grey.getPixelSize())
mono.copy(own)
print(passed(mono, got), got.pixel(2, 2).r, got.pixel(2, 2).b)
out.close()
inp.close()
