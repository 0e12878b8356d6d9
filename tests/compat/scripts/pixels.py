"""Images of each kind: sizes, rows, copies and conversions."""

import yarp

KINDS = (
    yarp.ImageRgb,
    yarp.ImageRgba,
    yarp.ImageMono,
    yarp.ImageMono16,
    yarp.ImageInt,
    yarp.ImageFloat,
    yarp.ImageRgbFloat,
)
for kind in KINDS:
    image = kind()
    print(kind.__name__, image.width(), image.getPixelCode(), image.getPixelSize())
    print(image.getQuantum(), image.getRowSize(), image.getRawImageSize())
    image.resize(5, 3)
    print(image.getQuantum(), image.getRowSize(), image.getPadding(), image.getRawImageSize())
    print(image.isPixel(4, 2), image.isPixel(5, 2), image.topIsLowIndex())
    image.zero()
    copied = kind()
    print(copied.copy(image), copied.width(), copied.getRowSize(), copied.copy(image, 3, 4))
    print(copied.width(), copied.height(), copied.copy(kind()), copied.width(), copied.height())
    image.setTopIsLowIndex(False)
    print(image.topIsLowIndex())
    sized = kind()
    sized.resize(image)
    print(sized.width(), sized.height())
colour = yarp.ImageRgb()
colour.resize(2, 2)
colour.zero()
pixel = colour.pixel(0, 0)
pixel.r, pixel.g, pixel.b = 10, 20, 30
print(colour.pixel(0, 0).r, colour.pixel(0, 0).g, colour.pixel(1, 1).b)
numbers = yarp.ImageFloat()
print(numbers.copy(colour), numbers.getPixel(0, 0), numbers.getPixel(1, 0))
numbers.setPixel(1, 0, 2.5)
print(numbers.getPixel(1, 0))
whole = yarp.ImageInt()
print(whole.copy(colour), whole.getPixel(0, 0))
whole.setPixel(1, 1, 7)
print(whole.getPixel(1, 1))
again = yarp.ImageRgb()
print(again.copy(numbers), again.pixel(0, 0).r, again.pixel(1, 0).g)
opaque = yarp.ImageRgba()
print(opaque.copy(colour), opaque.pixel(0, 0).r, opaque.pixel(0, 0).a)
grey, words = yarp.ImageMono(), yarp.Bottle()
print(yarp.Portable.copyPortable(colour, again), again.width())
print(yarp.Portable.copyPortable(colour, grey), grey.width(), grey.getPixelCode())
print(yarp.Portable.copyPortable(colour, words), words.toString())
