-- Vector and Matrix: tables of numbers.

local kit = ...

local unpack, pack, concat, type = string.unpack, string.pack, table.concat, type
local setmetatable, min = setmetatable, math.min

local fail, class, whole, real = kit.fail, kit.class, kit.whole, kit.real
local new_bottle, add, text_of, FLOAT64 = kit.new_bottle, kit.add, kit.text_of, kit.FLOAT64
local Vector, Matrix = {}, {}

local vector_meta = class(Vector, {
    __index = function(self, key)
        return type(key) == "number" and self:get(key) or Vector[key]
    end,
    __newindex = function(self, key, value)
        self:set(key, value)
    end,
})
local matrix_meta = class(Matrix)

local function inside(index, count)
    index = whole(index, "an index")
    if index < 0 or index >= count then
        fail("there is no element " .. index .. ", there are " .. count)
    end
    return index + 1
end

local function numbers(count, value)
    local made = {}
    for index = 1, count do
        made[index] = value
    end
    return made
end

local function read_numbers(data)
    local made = {}
    for index = 1, #data // 8 do
        made[index] = unpack("<d", data, index * 8 - 7)
    end
    return made
end

local function pack_numbers(values)
    local parts = {}
    for index = 1, #values do
        parts[index] = pack("<d", values[index])
    end
    return concat(parts)
end

local function new_vector(values)
    return setmetatable({ _v = values, _dirty = false }, vector_meta)
end

function Vector:size()
    return #self._v
end
Vector.length = Vector.size

function Vector:get(index)
    return self._v[inside(index, #self._v)]
end

function Vector:set(index, value)
    self._v[inside(index, #self._v)] = real(value)
    self._dirty = true
end

function Vector:push_back(value)
    self._v[#self._v + 1] = real(value)
    self._dirty = true
end

function Vector:resize(count, value)
    local values = self._v
    for index = #values, whole(count, "a size") + 1, -1 do
        values[index] = nil
    end
    for index = #values + 1, count do
        values[index] = real(value or 0)
    end
    self._dirty = true
end

function Vector:zero()
    self._v, self._dirty = numbers(#self._v, 0.0), true
end

function Vector:clear()
    self._v, self._dirty = {}, true
end

local function number_bottle(values)
    local made = new_bottle()
    for index = 1, #values do
        add(made, FLOAT64, values[index])
    end
    return made
end

function Vector:toString()
    return text_of(number_bottle(self._v))
end

local function new_matrix(rows, cols, values)
    return setmetatable({ _rows = rows, _cols = cols, _v = values, _dirty = false }, matrix_meta)
end

function Matrix:rows()
    return self._rows
end

function Matrix:cols()
    return self._cols
end

local function cell(self, row, col)
    return (inside(row, self._rows) - 1) * self._cols + inside(col, self._cols)
end

function Matrix:get(row, col)
    return self._v[cell(self, row, col)]
end

function Matrix:set(row, col, value)
    self._v[cell(self, row, col)] = real(value)
    self._dirty = true
end

function Matrix:zero()
    self._v, self._dirty = numbers(#self._v, 0.0), true
end

function Matrix:eye()
    self:zero()
    for index = 0, min(self._rows, self._cols) - 1 do
        self:set(index, index, 1)
    end
end

function Matrix:getRow(row)
    local values, first = {}, (inside(row, self._rows) - 1) * self._cols
    for index = 1, self._cols do
        values[index] = self._v[first + index]
    end
    return new_vector(values)
end

function Matrix:toString()
    return text_of(number_bottle(self._v))
end

kit.vector_meta, kit.matrix_meta = vector_meta, matrix_meta
kit.new_vector, kit.new_matrix = new_vector, new_matrix
kit.numbers, kit.read_numbers, kit.pack_numbers = numbers, read_numbers, pack_numbers
