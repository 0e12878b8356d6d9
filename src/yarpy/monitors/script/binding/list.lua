-- Bottle: a list of elements; Property: the Bottle of its groups `(key value ...)`.

local kit = ...

local setmetatable, pairs, type, tostring = setmetatable, pairs, type, tostring
local remove = table.remove

local INT32, STRING, VOCAB, FLOAT64 = kit.INT32, kit.STRING, kit.VOCAB, kit.FLOAT64
local INT64, INT8, INT16 = kit.INT64, kit.INT8, kit.INT16
local FLOAT32, LIST = kit.FLOAT32, kit.LIST
local Bottle, Property, property_meta = kit.Bottle, kit.Property, kit.property_meta
local host, checked, element, add = kit.host, kit.checked, kit.element, kit.add
local whole, within, real, vocab_code = kit.whole, kit.within, kit.real, kit.vocab_code
local new_bottle, read_bottle, copied = kit.new_bottle, kit.read_bottle, kit.copied
local text_of, data_of, new_value = kit.text_of, kit.data_of, kit.new_value

-- -- Bottle -------------------------------------------------------------------------------------

function Bottle:size()
    return self._n
end

function Bottle:isNull()
    return self._null or false
end

function Bottle:get(index)
    index = whole(index, "an index") + 1
    return new_value(self._t[index], self._v[index])
end

function Bottle:add(given)
    add(self, element(given, self._root))
end

for name, bits in pairs { addInt = 32, addInt8 = 8, addInt16 = 16, addInt32 = 32, addInt64 = 64 } do
    local tag = ({ [8] = INT8, [16] = INT16, [32] = INT32, [64] = INT64 })[bits]
    Bottle[name] = function(self, number)
        add(self, tag, within(number, bits))
    end
end
for name, tag in pairs { addDouble = FLOAT64, addFloat64 = FLOAT64, addFloat32 = FLOAT32 } do
    Bottle[name] = function(self, number)
        add(self, tag, real(number))
    end
end

function Bottle:addString(text)
    add(self, STRING, tostring(text))
end

function Bottle:addVocab32(word)
    add(self, VOCAB, type(word) == "string" and vocab_code(word) or within(word, 32))
end
Bottle.addVocab = Bottle.addVocab32

function Bottle:addBool(truth)
    add(self, VOCAB, truth and 49 or 0)
end

function Bottle:addList()
    local made = new_bottle(self._root)
    add(self, LIST, made)
    return made
end

function Bottle:pop()
    local count = self._n
    local last = new_value(self._t[count], self._v[count])
    if count > 0 then
        self._t[count], self._v[count], self._n = nil, nil, count - 1
        self._root._dirty = true
    end
    return last
end

function Bottle:clear()
    self._t, self._v, self._n = {}, {}, 0
    self._root._dirty = true
end

function Bottle:append(other)
    local given = copied(other, self._root, 0)
    for index = 1, given._n do
        add(self, given._t[index], given._v[index])
    end
end

function Bottle:copy(other, first, count)
    local given = copied(other, self._root, 0)
    self:clear()
    first = first and whole(first, "an index") or 0
    local last = first + (count and whole(count, "a number of elements") or given._n)
    for index = first + 1, last < given._n and last or given._n do
        if index > 0 then
            add(self, given._t[index], given._v[index])
        end
    end
end

function Bottle:tail()
    local made = new_bottle()
    made:copy(self, 1)
    return made
end

function Bottle:toString()
    return text_of(self)
end

function Bottle:fromString(text)
    self:copy(read_bottle(data_of(tostring(text))))
end

local function word_at(bottle, index)
    local tag, value = bottle._t[index], bottle._v[index]
    if tag == STRING then
        return value
    end
    return new_value(tag, value):toString()
end

local function null_bottle()
    local made = new_bottle()
    made._null = true
    return made
end

function Bottle:find(key)
    for index = 1, self._n do
        local tag, value = self._t[index], self._v[index]
        if tag == LIST then
            if value._n > 0 and word_at(value, 1) == key then
                return new_value(value._t[2], value._v[2])
            end
        elseif tag < LIST and word_at(self, index) == key then
            return new_value(self._t[index + 1], self._v[index + 1])
        end
    end
    return new_value()
end

function Bottle:findGroup(key)
    for index = 1, self._n do
        local tag, value = self._t[index], self._v[index]
        if tag == LIST then
            if value._n > 0 and word_at(value, 1) == key then
                return value
            end
        elseif tag < LIST and word_at(self, index) == key then
            break
        end
    end
    return null_bottle()
end

function Bottle:check(key)
    return not self:findGroup(key):isNull() or not self:find(key):isNull()
end

-- -- Property: the Bottle of its groups `(key value ...)` ---------------------------------------

local function new_property(bottle)
    return setmetatable({ _b = bottle or new_bottle() }, property_meta)
end

local function place_of(self, key)
    local bottle = self._b
    for index = bottle._n, 1, -1 do
        local value = bottle._v[index]
        if bottle._t[index] == LIST and value._n > 0 and word_at(value, 1) == key then
            return index
        end
    end
end

function Property:find(key)
    local group = self:findGroup(key)
    return new_value(group._t[2], group._v[2])
end

function Property:findGroup(key)
    local index = place_of(self, key)
    return index and self._b._v[index] or null_bottle()
end

function Property:check(key)
    return place_of(self, key) ~= nil
end

function Property:unput(key)
    local bottle, index = self._b, place_of(self, key)
    if index then
        remove(bottle._t, index)
        remove(bottle._v, index)
        bottle._n = bottle._n - 1
        bottle._root._dirty = true
    end
end

function Property:addGroup(key)
    self:unput(key)
    local group = self._b:addList()
    group:addString(key)
    return setmetatable({ _b = group }, property_meta)
end

function Property:put(key, given)
    local tag, value = element(given, self._b._root)
    self:unput(key)
    local group = self._b:addList()
    group:addString(key)
    add(group, tag, value)
end

function Property:clear()
    self._b:clear()
end

function Property:toString()
    return text_of(self._b)
end

function Property:fromString(text, keep)
    local given = read_bottle(data_of(tostring(text)))
    if keep ~= true then
        self._b:clear()
    end
    for index = 1, given._n do
        if given._t[index] == LIST then
            self:unput(word_at(given._v[index], 1))
            add(self._b, LIST, copied(given._v[index], self._b._root, 0))
        end
    end
end

kit.new_property = new_property
