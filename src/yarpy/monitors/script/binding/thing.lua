-- The `thing` passed to callbacks, the module yarp, and what Python calls.

local kit, run = ...

local pack, concat, spread = string.pack, table.concat, table.unpack
local type, error, select, next, load, pcall = type, error, select, next, load, pcall
local setmetatable, getmetatable = setmetatable, getmetatable
local tostring, pairs, ipairs = tostring, pairs, ipairs

local INT32, FLOAT64, LIST = kit.INT32, kit.FLOAT64, kit.LIST
local host, checked, fail, whole, element = kit.host, kit.checked, kit.fail, kit.whole, kit.element
local bottle_meta, property_meta, value_meta = kit.bottle_meta, kit.property_meta, kit.value_meta
local vector_meta, matrix_meta, image_meta = kit.vector_meta, kit.matrix_meta, kit.image_meta
local new_bottle, read_bottle, bytes_of = kit.new_bottle, kit.read_bottle, kit.bytes_of
local new_value, one_of, new_property = kit.new_value, kit.one_of, kit.new_property
local new_vector, new_matrix, numbers = kit.new_vector, kit.new_matrix, kit.numbers
local read_numbers, pack_numbers = kit.read_numbers, kit.pack_numbers
local new_image, pixels = kit.new_image, kit.pixels
local vocab_code, vocab_text = kit.vocab_code, kit.vocab_text
local Things = {}

-- -- what callbacks are given -------------------------------------------------------------------

local things_meta = { __index = Things }

local function new_things(message)
    return setmetatable({ _message = message, _casts = {} }, things_meta)
end

local thing = new_things(true) -- the current message

local function fetch_bottle()
    local problem, data = host.fetch_bottle()
    if problem == nil then
        local ok, made = pcall(read_bottle, data)
        return ok and made or nil
    end
end

local CASTS = {
    Bottle = fetch_bottle,
    Property = function()
        local bottle = fetch_bottle()
        return bottle and new_property(bottle)
    end,
    Value = function()
        local bottle = fetch_bottle()
        if bottle == nil then
            return nil
        elseif bottle._n == 1 then
            return new_value(bottle._t[1], bottle._v[1])
        end
        return new_value(LIST, bottle)
    end,
    Vector = function()
        local problem, data = host.fetch_vector()
        return problem == nil and new_vector(read_numbers(data)) or nil
    end,
    Matrix = function()
        local problem, rows, cols, data = host.fetch_matrix()
        return problem == nil and new_matrix(rows, cols, read_numbers(data)) or nil
    end,
}

local function image_cast(wanted)
    return function()
        local problem, code, width, height, format, channels, data = host.fetch_image(wanted)
        return problem == nil and new_image(code, width, height, format, channels, data) or nil
    end
end

for name, code in pairs {
    Image = "", ImageOfPixelRgb = "rgb", ImageOfPixelBgr = "bgr", ImageOfPixelMono = "mono",
    ImageOfPixelRgba = "rgba", ImageOfPixelMono16 = "mo16", ImageOfPixelFloat = "dec",
} do
    CASTS[name] = image_cast(code)
end

for name, cast in pairs(CASTS) do
    Things["as" .. name] = function(self)
        if self._writer ~= nil then
            return self._writer
        end
        local made = self._casts[name]
        if made == nil and self._message then
            made = cast()
            self._casts[name] = made
        end
        return made
    end
end

function Things:setPortWriter(object)
    self._writer = object
end

function Things:getPortWriter()
    return self._writer
end

function Things:hasBeenRead()
    return next(self._casts) ~= nil
end

function Things:reset()
    self._writer, self._casts = nil, {}
end

-- An object as returned to Python: the kind of its bytes, the bytes, and what else that kind takes.
local function outgoing(object)
    local meta = getmetatable(object)
    if meta == bottle_meta then
        return "message", bytes_of(object)
    elseif meta == property_meta then
        return "message", bytes_of(object._b)
    elseif meta == value_meta then
        return "message", bytes_of(object._t == LIST and object._v or one_of(object))
    elseif meta == vector_meta then
        return "message", pack("<i4i4", LIST | FLOAT64, #object._v) .. pack_numbers(object._v)
    elseif meta == matrix_meta then
        local head = pack("<i4i4i4i4i4i4i4i4", LIST, 3, INT32, object._rows, INT32, object._cols,
            LIST | FLOAT64, #object._v)
        return "message", head .. pack_numbers(object._v)
    elseif meta == image_meta then
        return "image", pixels(object), object._code, object._width, object._height
    end
    fail("an update gives the thing, or one of yarp's objects, not a " .. type(object))
end

local function is_dirty(object)
    if object._b then
        return object._b._root._dirty
    end
    return object._dirty or (object._v and type(object._v) == "table" and object._v._dirty)
end

-- The result for the message: nothing if it is unchanged.
local function result(given)
    if given == nil then
        given = thing
    end
    if type(given) ~= "table" then
        fail("an update gives the thing, or one of yarp's objects, not a " .. type(given))
    end
    if getmetatable(given) ~= things_meta then
        return outgoing(given)
    end
    if given._writer ~= nil then
        return outgoing(given._writer)
    end
    for _, object in pairs(given._casts) do
        if is_dirty(object) then
            return outgoing(object)
        end
    end
end

-- -- the module ---------------------------------------------------------------------------------

local function now()
    return checked(host.now())
end

local function image_maker(code, format, channels)
    return function()
        return new_image(code, 0, 0, format, channels, "")
    end
end

yarp = {
    Bottle = function(text)
        local made = new_bottle()
        if type(text) == "string" then
            made:fromString(text)
        elseif text ~= nil then
            made:copy(text)
        end
        return made
    end,
    Property = function(text)
        local made = new_property()
        if type(text) == "string" then
            made:fromString(text)
        end
        return made
    end,
    Value = function(given)
        if given == nil then
            return new_value()
        end
        return new_value(element(given))
    end,
    Vector = function(given, value)
        if type(given) == "table" then
            return new_vector({ spread(given._v) })
        end
        local made = new_vector({})
        made:resize(given or 0, value)
        return made
    end,
    Matrix = function(rows, cols)
        rows, cols = whole(rows or 0, "a size"), whole(cols or 0, "a size")
        return new_matrix(rows, cols, numbers(rows * cols, 0.0))
    end,
    Things = function()
        return new_things(false)
    end,
    ImageRgb = image_maker("rgb", "<B", 3),
    ImageBgr = image_maker("bgr", "<B", 3),
    ImageRgba = image_maker("rgba", "<B", 4),
    ImageMono = image_maker("mono", "<B", 1),
    ImageMono16 = image_maker("mo16", "<I2", 1),
    ImageFloat = image_maker("dec", "<f", 1),
    Time = { now = now },
    Time_now = now,
    now = now,
    Vocab32_encode = vocab_code,
    Vocab32_decode = vocab_text,
    Vocab_encode = vocab_code,
    Vocab_decode = vocab_text,
    encode = vocab_code,
    decode = vocab_text,
}
package.loaded.yarp = yarp

function print(...)
    local parts = {}
    for index = 1, select("#", ...) do
        parts[index] = tostring((select(index, ...)))
    end
    checked(host.say(concat(parts, "\t")))
end

PortMonitor = {}
for _, name in ipairs {
    "setEvent", "unsetEvent", "setConstraint", "getConstraint", "setTrigInterval",
    "unsetTrigInterval",
} do
    PortMonitor[name] = function(...)
        return checked(host[name](...))
    end
end

-- -- what Python calls --------------------------------------------------------------------------

local function callback(name)
    local found = PortMonitor[name]
    return type(found) == "function" and found or nil
end

local function begin()
    thing._writer, thing._casts = nil, {}
end

local function is_changed()
    if thing._writer ~= nil then
        return true
    end
    for _, object in next, thing._casts do
        if is_dirty(object) then
            return true
        end
    end
    return false
end

local inside = {
    has = function(name)
        return callback(name) ~= nil
    end,
    load = function(source, name)
        local chunk, problem = load(source, name, "t")
        if chunk == nil then
            error(problem, 0)
        end
        chunk()
        if type(PortMonitor) ~= "table" then
            error("the global PortMonitor must stay a table", 0)
        end
    end,
    create = function(options)
        return callback("create")(new_property(read_bottle(options))) and true or false
    end,
    destroy = function()
        callback("destroy")()
    end,
    -- 0: it may not pass, 1: it may, 2: it may, and was changed
    accept = function()
        begin()
        if not PortMonitor.accept(thing) then
            return 0
        end
        return is_changed() and 2 or 1
    end,
    update = function()
        return result(PortMonitor.update(thing))
    end,
    update_unseen = function()
        begin()
        return result(PortMonitor.update(thing))
    end,
    update_reply = function()
        begin()
        return result(PortMonitor.update_reply(thing))
    end,
    result = function()
        return result()
    end,
    trig = function()
        callback("trig")()
    end,
    setparam = function(given)
        callback("setparam")(new_property(read_bottle(given)))
    end,
    getparam = function()
        local found = callback("getparam")()
        if found == nil then
            return nil
        end
        local _, bytes = outgoing(found)
        return bytes
    end,
}

-- Each returns true and its results, or false and a message.
local guarded = {}
for name, f in pairs(inside) do
    guarded[name] = function(...)
        return run(f, ...)
    end
end
return guarded
