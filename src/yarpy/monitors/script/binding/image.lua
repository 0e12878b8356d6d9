-- Image: its pixels as received, and changed rows as tables of bytes.

local kit = ...

local pack, unpack, packsize, char = string.pack, string.unpack, string.packsize, string.char
local concat, spread, move, min = table.concat, table.unpack, table.move, math.min
local setmetatable, rawget, type, pcall = setmetatable, rawget, type, pcall
local pairs, ipairs, tostring = pairs, ipairs, tostring

local fail, class, whole, real = kit.fail, kit.class, kit.whole, kit.real
local vocab_code = kit.vocab_code
local Image = {}

local image_meta = class(Image)

local pixel_meta = {
    __index = function(pixel, name)
        local image = rawget(pixel, "_image")
        local channel = image._names[name]
        return channel and image:_read(rawget(pixel, "_x"), rawget(pixel, "_y"), channel)
    end,
    __newindex = function(pixel, name, value)
        local image = rawget(pixel, "_image")
        local channel = image._names[name]
        if channel == nil then
            fail("a pixel of this image has no " .. tostring(name))
        end
        image:_write(rawget(pixel, "_x"), rawget(pixel, "_y"), channel, value)
    end,
}

local ORDERS = { rgb = "rgb", bgr = "bgr", rgba = "rgba", bgra = "bgra", hsv = "hsv",
    ["rgb-"] = "rgb", ["rgb."] = "rgb", rgbi = "rgb", ["hsv."] = "hsv" }

-- format: how string.pack writes one channel
local function new_image(code, width, height, format, channels, data)
    local names = {}
    for index = 1, #(ORDERS[code] or "") do
        names[ORDERS[code]:sub(index, index)] = index - 1
    end
    local size = packsize(format)
    return setmetatable({
        _code = code, _width = width, _height = height, _format = format, _size = size,
        _channels = channels, _names = names, _data = data, _rows = {}, _dirty = false,
        _row = width * channels * size,
    }, image_meta)
end

function Image:width()
    return self._width
end

function Image:height()
    return self._height
end

function Image:getPixelCode()
    return vocab_code(self._code)
end

function Image:getPixelSize()
    return self._channels * self._size
end

function Image:getRowSize()
    return self._row
end

function Image:getRawImageSize()
    return self._row * self._height
end

local function offset(self, x, y, channel)
    x, y = whole(x, "a column"), whole(y, "a row")
    if x < 0 or y < 0 or x >= self._width or y >= self._height then
        fail("no pixel (" .. x .. ", " .. y .. ") in an image of " .. self._width .. " x "
            .. self._height)
    end
    return (x * self._channels + channel) * self._size + 1, y
end

function Image:_read(x, y, channel)
    local at, row = offset(self, x, y, channel)
    local changed = self._rows[row]
    if changed == nil then
        return (unpack(self._format, self._data, row * self._row + at))
    end
    if self._size == 1 then
        return (unpack(self._format, char(changed[at])))
    end
    return (unpack(self._format, char(spread(changed, at, at + self._size - 1))))
end

function Image:_write(x, y, channel, value)
    local at, y_row = offset(self, x, y, channel)
    local row = self._rows[y_row]
    if row == nil then
        row = {}
        local first = y_row * self._row
        for start = 1, self._row, 4000 do -- a call can return this many results
            local last = min(start + 3999, self._row)
            move({ self._data:byte(first + start, first + last) }, 1, last - start + 1,
                start, row)
        end
        self._rows[y_row] = row
    end
    local kind = self._format
    local ok, packed = pcall(pack, kind, (kind == "<f") and real(value) or whole(value))
    if not ok then
        fail(tostring(value) .. " does not fit in a pixel of this image")
    end
    for index = 1, self._size do
        row[at + index - 1] = packed:byte(index)
    end
    self._dirty = true
end

function Image:pixel(x, y)
    if self._channels == 1 then
        return self:_read(x, y, 0)
    end
    offset(self, x, y, 0)
    return setmetatable({ _image = self, _x = x, _y = y }, pixel_meta)
end
Image.safePixel = Image.pixel

function Image:getPixel(x, y)
    return self:_read(x, y, 0)
end

function Image:setPixel(x, y, value)
    if self._channels > 1 and type(value) == "table" then
        for name in pairs(self._names) do
            self:pixel(x, y)[name] = value[name]
        end
        return
    end
    self:_write(x, y, 0, value)
end

function Image:isPixel(x, y)
    return x >= 0 and y >= 0 and x < self._width and y < self._height
end

function Image:resize(width, height)
    width, height = whole(width, "a width"), whole(height, "a height")
    if width < 0 or height < 0 or width > 1 << 20 or height > 1 << 20 then
        fail("an image cannot be " .. width .. " x " .. height)
    end
    self._width, self._height = width, height
    self._row = width * self._channels * self._size
    self:zero()
end

function Image:zero()
    self._data, self._rows, self._dirty = ("\0"):rep(self._row * self._height), {}, true
end

local function pixels(self)
    local parts = {}
    for y = 0, self._height - 1 do
        local row = self._rows[y]
        if row then
            for start = 1, self._row, 4000 do
                local last = min(start + 3999, self._row)
                parts[#parts + 1] = char(spread(row, start, last))
            end
        else
            parts[#parts + 1] = self._data:sub(y * self._row + 1, (y + 1) * self._row)
        end
    end
    return concat(parts)
end

function Image:copy(other)
    self._data, self._rows, self._dirty = pixels(other), {}, true
    for _, name in ipairs { "_code", "_width", "_height", "_format", "_size", "_channels",
        "_names", "_row" } do
        self[name] = other[name]
    end
end

function Image:toString()
    return "[" .. self._code .. "] " .. self._width .. " x " .. self._height
end

kit.image_meta, kit.new_image, kit.pixels = image_meta, new_image, pixels
