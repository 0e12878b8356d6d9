"""Matrix: rows and columns of float64 that ports send."""

from __future__ import annotations

from typing import Any

import yarpy
from yarp._portable import Portable
from yarp._value import number
from yarp._vector import Vector, row


class Matrix(Portable):
    """`Matrix(rows, cols)` of zeros; `m[1, 2]` or `get` and `set`."""

    _rows: list[list[float]]
    _cols: int

    def __init__(self, r: int | Matrix = 0, c: int = 0) -> None:
        if isinstance(r, Matrix):
            self._rows = [[*one] for one in r._rows]
            self._cols = r._cols
        else:
            self._rows = [[0.0] * c for _ in range(r)]
            self._cols = c

    def _outgoing(self) -> Any:
        import numpy as np

        return yarpy.Matrix(np.array(self._rows, "<f8").reshape(len(self._rows), self._cols))

    def _take(self, message: yarpy.Message) -> None:
        found = message.as_(yarpy.Matrix)
        self._rows, self._cols = found.array.tolist(), found.cols

    def rows(self) -> int:
        return len(self._rows)

    def cols(self) -> int:
        return self._cols

    def get(self, i: int, j: int) -> float:
        """The number in a row and column."""
        return self._rows[i][j]

    access = get

    def set(self, i: int, j: int, v: float) -> None:
        """Change the number in a row and column."""
        self._rows[i][j] = number(v)

    def __getitem__(self, where: tuple[int, int]) -> float:
        if not isinstance(where, tuple):
            raise ValueError("a matrix has two indices: m[1, 2]")
        return self._rows[where[0]][where[1]]

    def __setitem__(self, where: tuple[int, int], value: float) -> None:
        self._rows[where[0]][where[1]] = number(value)

    def resize(self, r: int, c: int) -> None:
        """Another size; what fits stays."""
        old = self._rows
        self._rows = [([*old[i]] if i < len(old) else [])[:c] for i in range(r)]
        for one in self._rows:
            one += [0.0] * (c - len(one))
        self._cols = c

    def zero(self) -> None:
        """Set all to 0."""
        self._rows = [[0.0] * self._cols for _ in self._rows]

    def eye(self) -> Matrix:
        """Become the identity."""
        for i, one in enumerate(self._rows):
            one[:] = [float(i == j) for j in range(self._cols)]
        return self

    def diagonal(self, d: Vector) -> Matrix:
        """Become the matrix with this diagonal."""
        for i, one in enumerate(self._rows):
            one[:] = [d[i] if i == j and i < len(d) else 0.0 for j in range(self._cols)]
        return self

    def getRow(self, r: int) -> Vector:
        return Vector(self._rows[r])

    def getCol(self, c: int) -> Vector:
        return Vector([one[c] for one in self._rows])

    def setRow(self, row: int, r: Vector) -> bool:
        if not 0 <= row < len(self._rows) or len(r) != self._cols:
            return False
        self._rows[row] = [*r]
        return True

    def setCol(self, col: int, c: Vector) -> bool:
        if not 0 <= col < self._cols or len(c) != len(self._rows):
            return False
        for one, value in zip(self._rows, c, strict=True):
            one[col] = value
        return True

    def transposed(self) -> Matrix:
        found = Matrix(self._cols, len(self._rows))
        for i, one in enumerate(self._rows):
            for j, value in enumerate(one):
                found._rows[j][i] = value
        return found

    def submatrix(self, r1: int, r2: int, c1: int, c2: int) -> Matrix:
        """Rows and columns from one index to another, both included."""
        found = Matrix()
        found._rows = [one[c1 : c2 + 1] for one in self._rows[r1 : r2 + 1]]
        found._cols = c2 - c1 + 1
        return found

    def subrow(self, r: int, c: int, size: int) -> Vector:
        return Vector(self._rows[r][c : c + size])

    def subcol(self, r: int, c: int, size: int) -> Vector:
        return Vector([one[c] for one in self._rows[r : r + size]])

    def setSubmatrix(self, m: Matrix, r: int, c: int) -> bool:
        """Put another matrix into this one."""
        if r + m.rows() > self.rows() or c + m.cols() > self.cols():
            return False
        for i, one in enumerate(m._rows):
            self._rows[r + i][c : c + m._cols] = one
        return True

    def setSubrow(self, v: Vector, r: int, c: int) -> bool:
        if not 0 <= r < self.rows() or c + len(v) > self._cols:
            return False
        self._rows[r][c : c + len(v)] = [*v]
        return True

    def setSubcol(self, v: Vector, r: int, c: int) -> bool:
        if not 0 <= c < self._cols or r + len(v) > self.rows():
            return False
        for i, value in enumerate(v):
            self._rows[r + i][c] = value
        return True

    def removeRows(self, first_row: int, how_many: int) -> Matrix:
        del self._rows[first_row : first_row + how_many]
        return self

    def removeCols(self, first_col: int, how_many: int) -> Matrix:
        for one in self._rows:
            del one[first_col : first_col + how_many]
        self._cols -= how_many
        return self

    def isEqual(self, r: Matrix) -> bool:
        return self._cols == r._cols and self._rows == r._rows

    def data(self) -> list[list[float]]:
        """The rows as lists."""
        return self._rows

    def toString(self, precision: int = -1, width: int = -1, endRowStr: str = "\n") -> str:
        """The numbers as text, a line for each row."""
        return endRowStr.join(row(one, precision, width) for one in self._rows)

    def toString_c(self) -> str:
        return self.toString()

    def __repr__(self) -> str:
        return f"Matrix({self._rows!r})"


def removeCols(in_: Matrix, out: Matrix, first_col: int, how_many: int) -> bool:
    """Store the matrix without some columns; False if some are outside."""
    inside = first_col >= 0 and how_many >= 0 and first_col + how_many <= in_.cols()
    if inside:
        out._rows, out._cols = [[*one] for one in in_._rows], in_._cols
        out.removeCols(first_col, how_many)
    return inside


def removeRows(in_: Matrix, out: Matrix, first_row: int, how_many: int) -> bool:
    """Store the matrix without some rows; False if some are outside."""
    inside = first_row >= 0 and how_many >= 0 and first_row + how_many <= in_.rows()
    if inside:
        out._rows, out._cols = [[*one] for one in in_._rows], in_._cols
        out.removeRows(first_row, how_many)
    return inside


def submatrix(in_: Matrix, out: Matrix, r1: int, r2: int, c1: int, c2: int) -> bool:
    """Store rows and columns from one index to another, both included; False if not inside."""
    inside = 0 <= r1 <= r2 < in_.rows() and 0 <= c1 <= c2 < in_.cols()
    if inside:
        found = in_.submatrix(r1, r2, c1, c2)
        out._rows, out._cols = found._rows, found._cols
    return inside
