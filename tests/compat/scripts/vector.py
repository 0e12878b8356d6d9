"""Vector, VectorInt, Matrix, and the lists of one kind."""

import yarp

v = yarp.Vector(3)
w = yarp.Vector(2, 7.5)
print(v.size(), v.toString())
print(w.toString(), "|", w.toString(2), "|", w.toString(2, 8))
v[1] = 4
v.set(2, -3.25)
print(v[1], v.get(2), v.toString(), v.length())
v.push_back(9)
print(v.toString(), v.size())
v.pop_back()
print(v.subVector(0, 1).toString())
v.zero()
print(v.toString())
v.resize(5)
print(v.toString())
v.resize(2, 1.0)
print(v.toString(), v.isEqual(w), v.getBottleTag(), v.getElementSize())
v.clear()
print(v.size(), yarp.Vector([1, 2, 3]).toString())
print(yarp.Vector(yarp.Vector(2, 1.0)).toString())
print(yarp.VectorInt(2).toString(), yarp.VectorInt(2, 3).toString())

d = yarp.DVector(3)
print(d.size(), list(d), d[0])
d.push_back(1.5)
print(list(d), len(d))
d.resize(2)
print(list(d), yarp.DVector([1, 2]).size(), yarp.DVector(2, 5.0)[1], d.empty())
d.clear()
d.append(3)
print(d.front(), d.back(), d.pop(), d.empty())
i = yarp.IVector(2)
i.push_back(3)
print(list(i), list(yarp.BVector(2)), yarp.SVector(1)[0] == "", list(yarp.DVector((1, 2, 3))))
try:
    d[5]
except IndexError:
    print("no such index")

m = yarp.Matrix(2, 3)
print(m.rows(), m.cols(), m.get(0, 1))
m.set(0, 1, 2.5)
m[1, 2] = 4
print(m.get(0, 1), m[1, 2], m[(0, 1)])
print(m.getRow(0).toString(), m.getCol(1).toString(), m.transposed().rows())
e = yarp.Matrix(2, 2)
e.eye()
print(e.get(0, 0), e.get(0, 1), e.get(1, 1), e.isEqual(e))
m.zero()
print(m.get(0, 1))
m.resize(1, 1)
print(m.rows(), m.cols())
