-- The elements of lists as Lua scripts of C++ YARP see them: how messages are read and written.
--
-- A list keeps the tags and the values of its elements side by side; `_root` is the list of the
-- whole message, which knows whether anything was changed. Only numbers and strings go to Python.
-- `host` holds Python functions, which return an error message or nil, then their results. `fail`
-- raises an error at the line of the script.

local host, fail, charge = ...

-- Scripts may redefine globals.
local pack, unpack, concat = string.pack, string.unpack, table.concat
local type, error, tonumber, tostring, pairs = type, error, tonumber, tostring, pairs
local setmetatable, getmetatable = setmetatable, getmetatable
local floor, ceil, min, math_type = math.floor, math.ceil, math.min, math.type

local INT32, STRING, VOCAB, FLOAT64, BLOB, INT64 = 1, 4, 9, 10, 12, 17
local INT8, INT16, FLOAT32, LIST, DICT = 32, 64, 128, 256, 512
local FORMATS = {
    [INT32] = "<i4", [STRING] = "<s4", [VOCAB] = "<i4", [FLOAT64] = "<d", [BLOB] = "<s4",
    [INT64] = "<i8", [INT8] = "<i1", [INT16] = "<i2", [FLOAT32] = "<f",
}
local MAX_DEPTH = 100

-- The results of a Python function.
local function checked(problem, ...)
    if problem then
        fail(problem)
    end
    return ...
end

local function class(methods, extra)
    local meta = { __index = methods, __tostring = function(self) return self:toString() end }
    for key, value in pairs(extra or {}) do
        meta[key] = value
    end
    return meta
end

local Bottle, Property, Value = {}, {}, {}
local bottle_meta, property_meta, value_meta = class(Bottle), class(Property), class(Value)

local function new_bottle(root)
    local made = setmetatable({ _t = {}, _v = {}, _n = 0 }, bottle_meta)
    made._root = root or made
    return made
end

local function read_items(data, pos, kind, count, bottle, depth)
    local tags, values = bottle._t, bottle._v
    local tag, value = kind, nil
    for index = 1, count do
        if kind == 0 then
            tag, pos = unpack("<i4", data, pos)
        end
        local format = FORMATS[tag]
        if format then
            value, pos = unpack(format, data, pos)
        elseif LIST <= tag and tag < 2 * DICT and depth < MAX_DEPTH then
            local code, size = tag, nil
            if tag & DICT ~= 0 then
                code, pos = unpack("<i4", data, pos)
            end
            size, pos = unpack("<i4", data, pos)
            value = new_bottle(bottle._root)
            pos = read_items(data, pos, code & 255, size, value, depth + 1)
            tag = LIST | (tag & DICT)
        else
            error("no list", 0)
        end
        tags[index], values[index] = tag, value
    end
    bottle._n = count > 0 and count or 0
    return pos
end

local function read_bottle(data)
    local made = new_bottle()
    local code, count, pos = unpack("<i4i4", data)
    read_items(data, pos, code & 255, count, made, 0)
    return made
end

-- The code of a list, and the bytes after it.
local function pack_list(bottle, depth)
    if depth > MAX_DEPTH then
        fail("lists are nested more than " .. MAX_DEPTH .. " deep")
    end
    local tags, values, count = bottle._t, bottle._v, bottle._n
    local common = count > 0 and tags[1] or 0
    if common >= LIST then
        common = 0
    end
    for index = 2, count do
        if tags[index] ~= common then
            common = 0
            break
        end
    end
    local parts = { pack("<i4", count) }
    for index = 1, count do
        local tag, value = tags[index], values[index]
        if tag < LIST then
            if common == 0 then
                parts[#parts + 1] = pack("<i4", tag)
            end
            parts[#parts + 1] = pack(FORMATS[tag], value)
        else
            local code, body = pack_list(value, depth + 1)
            if tag & DICT ~= 0 then
                parts[#parts + 1] = pack("<i4i4", LIST | DICT, code)
            else
                parts[#parts + 1] = pack("<i4", code)
            end
            parts[#parts + 1] = body
        end
    end
    return LIST | common, concat(parts)
end

local function bytes_of(bottle)
    local code, body = pack_list(bottle, 0)
    return pack("<i4", code) .. body
end

local function text_of(bottle)
    local data = bytes_of(bottle)
    charge(8 * #data) -- Python reads it, and nobody counts there
    return checked(host.text_of(data))
end

local function data_of(text)
    charge(8 * #text)
    return checked(host.bytes_of(text))
end

local function copied(bottle, root, depth)
    if depth > MAX_DEPTH then
        fail("lists are nested more than " .. MAX_DEPTH .. " deep")
    end
    local made = new_bottle(root)
    for index = 1, bottle._n do
        local tag, value = bottle._t[index], bottle._v[index]
        made._t[index] = tag
        made._v[index] = tag >= LIST and copied(value, made._root, depth + 1) or value
    end
    made._n = bottle._n
    return made
end

local function add(bottle, tag, value)
    local count = bottle._n + 1
    bottle._t[count], bottle._v[count], bottle._n = tag, value, count
    bottle._root._dirty = true
end

local function whole(number, what)
    local found = tonumber(number)
    if found == nil or found ~= found or found >= 2 ^ 63 or found < -2 ^ 63 then
        fail((what or "a number") .. " is needed, not " .. tostring(number))
    end
    return found >= 0 and floor(found) or ceil(found)
end

local function within(number, bits)
    local found = whole(number)
    local limit = 1 << (bits - 1)
    if bits < 64 and (found >= limit or found < -limit) then
        fail(found .. " does not fit in " .. bits .. " bits")
    end
    return found
end

local function real(number)
    local found = tonumber(number)
    if found == nil then
        fail("a number is needed, not " .. tostring(number))
    end
    return found + 0.0
end

local function vocab_code(word)
    local code = 0
    for index = min(#word, 4), 1, -1 do
        code = code << 8 | word:byte(index)
    end
    return unpack("<i4", pack("<I4", code))
end

local function vocab_text(code)
    return (pack("<i4", code):match("^[^\0]*"))
end

-- What add, put and Value take: a Value, a Bottle, or a plain Lua value.
local function element(given, root)
    local kind = type(given)
    if kind == "table" then
        local meta = getmetatable(given)
        if meta == value_meta then
            if given._t >= LIST then
                return given._t, copied(given._v, root, 0)
            end
            return given._t, given._v
        elseif meta == bottle_meta then
            return LIST, copied(given, root, 0)
        elseif meta == property_meta then
            return LIST | DICT, copied(given._b, root, 0)
        end
    elseif kind == "string" then
        return STRING, given
    elseif kind == "boolean" then
        return VOCAB, given and 49 or 0
    elseif math_type(given) == "integer" then
        return (given < 1 << 31 and given >= -(1 << 31)) and INT32 or INT64, given
    elseif kind == "number" then
        return FLOAT64, given
    end
    fail("this cannot be an element of a list: " .. kind)
end

return {
    host = host, fail = fail, checked = checked, class = class,
    Bottle = Bottle, Property = Property, Value = Value,
    bottle_meta = bottle_meta, property_meta = property_meta, value_meta = value_meta,
    INT32 = INT32, STRING = STRING, VOCAB = VOCAB, FLOAT64 = FLOAT64, BLOB = BLOB, INT64 = INT64,
    INT8 = INT8, INT16 = INT16, FLOAT32 = FLOAT32, LIST = LIST, DICT = DICT,
    new_bottle = new_bottle, read_bottle = read_bottle, bytes_of = bytes_of, text_of = text_of, data_of = data_of,
    copied = copied, add = add, element = element, whole = whole, within = within, real = real,
    vocab_code = vocab_code, vocab_text = vocab_text,
}
