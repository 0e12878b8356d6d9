-- Value: one element of a list, as a number, a text, a list.

local kit = ...

local setmetatable, ipairs, floor, ceil = setmetatable, ipairs, math.floor, math.ceil

local INT32, STRING, VOCAB, FLOAT64 = kit.INT32, kit.STRING, kit.VOCAB, kit.FLOAT64
local BLOB, INT64, INT8, INT16 = kit.BLOB, kit.INT64, kit.INT8, kit.INT16
local FLOAT32, LIST, DICT = kit.FLOAT32, kit.LIST, kit.DICT
local Value, value_meta, property_meta = kit.Value, kit.value_meta, kit.property_meta
local new_bottle, add, text_of = kit.new_bottle, kit.add, kit.text_of
local vocab_code, vocab_text = kit.vocab_code, kit.vocab_text

local INTEGER = { [INT32] = true, [INT64] = true, [INT8] = true, [INT16] = true }
local FLOAT = { [FLOAT64] = true, [FLOAT32] = true }

local function new_value(tag, value)
    return setmetatable({ _t = tag or 0, _v = value }, value_meta)
end

local function as_integer(self)
    local tag, value = self._t, self._v
    if INTEGER[tag] or tag == VOCAB then
        return value
    elseif FLOAT[tag] and value == value and value < 2 ^ 63 and value >= -2 ^ 63 then
        return value >= 0 and floor(value) or ceil(value)
    end
    return 0
end

local function as_float(self)
    local tag = self._t
    return (FLOAT[tag] or INTEGER[tag] or tag == VOCAB) and self._v + 0.0 or 0.0
end

for _, name in ipairs { "asInt", "asInt8", "asInt16", "asInt32", "asInt64" } do
    Value[name] = as_integer
end
for _, name in ipairs { "asDouble", "asFloat32", "asFloat64" } do
    Value[name] = as_float
end

local function tests(tags)
    return function(self)
        return tags[self._t] or false
    end
end

Value.isInt8, Value.isInt16 = tests { [INT8] = true }, tests { [INT16] = true }
Value.isInt32, Value.isInt64 = tests { [INT32] = true }, tests { [INT64] = true }
Value.isInt = Value.isInt32
Value.isFloat32, Value.isFloat64 = tests { [FLOAT32] = true }, tests { [FLOAT64] = true }
Value.isDouble = Value.isFloat64
Value.isString, Value.isBlob = tests { [STRING] = true }, tests { [BLOB] = true }
Value.isVocab32 = tests { [VOCAB] = true }
Value.isVocab = Value.isVocab32
Value.isList, Value.isDict = tests { [LIST] = true }, tests { [LIST | DICT] = true }
Value.isNull = tests { [0] = true }

function Value:isBool()
    return self._t == VOCAB and (self._v == 49 or self._v == 0)
end

function Value:asBool()
    local tag, value = self._t, self._v
    return (INTEGER[tag] or FLOAT[tag] or tag == VOCAB) and value ~= 0 or value == "true"
end

function Value:asString()
    if self._t == STRING then
        return self._v
    end
    return self._t == VOCAB and vocab_text(self._v) or ""
end

function Value:asBlob()
    return self._t == BLOB and self._v or ""
end

function Value:asVocab32()
    return self._t == STRING and vocab_code(self._v) or as_integer(self)
end
Value.asVocab = Value.asVocab32

function Value:asList()
    return self._t == LIST and self._v or nil
end

function Value:asDict()
    return self._t == LIST | DICT and setmetatable({ _b = self._v }, property_meta) or nil
end

local function one_of(self)
    local made = new_bottle()
    if self._t ~= 0 then
        add(made, self._t, self._v)
    end
    return made
end

function Value:toString()
    if self._t == STRING then
        return self._v
    end
    return text_of(self._t == LIST and self._v or one_of(self))
end

for _, name in ipairs { "find", "findGroup", "check" } do
    Value[name] = function(self, ...)
        local inside = self:asList() or self:asDict() or new_bottle()
        return inside[name](inside, ...)
    end
end

kit.new_value, kit.one_of = new_value, one_of
