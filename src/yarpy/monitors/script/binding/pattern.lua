-- The functions of `string` that match patterns, in steps that the limits of a script can count.
--
-- One call of the originals may take longer than the world will last: "a-a-a-a-b" on a long text.
-- So they are used as long as even their worst cases together are short (`afford`), and for the rest
-- the same is done here, step by step. What is matched, captured and replaced is the same (Lua 5.4);
-- a pattern that is malformed is refused at once, not when the matching comes to its fault.

local charge, fail, afford = ...

local find, match, gmatch, gsub = string.find, string.match, string.gmatch, string.gsub
local byte, char, sub = string.byte, string.char, string.sub
local concat, unpack = table.concat, table.unpack
local type, tostring, tonumber, math_type = type, tostring, tonumber, math.type

local KEPT = 100 -- patterns that are remembered
local SHORT = 200 -- characters of those
local MOST_CAPTURES = 32

-- -- how long the originals may take ------------------------------------------------------------

local costs, kept = {}, 0

-- How many repetitions a pattern has at most, their ways to share one letter, and what each of the
-- ways takes: items that may be missing double it.
local function cost_of(p)
    local known = costs[p]
    if known then
        return known
    end
    local _, linear = gsub(p, "%%[b1-9]", "")
    local rest = gsub(p, "%%.", "")
    local _, repeated = gsub(rest, "[*+-]", "")
    local _, optional = gsub(rest, "?", "")
    local count = linear + repeated
    if byte(p) ~= 94 then
        count = count + 1 -- where it begins
    end
    known = { count, (#p + 1) * 2.0 ^ optional }
    for n = 2, count do
        known[2] = known[2] / n
    end
    if #p <= SHORT then
        if kept >= KEPT then
            costs, kept = {}, 0
        end
        costs[p], kept = known, kept + 1
    end
    return known
end

-- Whether the original will do; it also says what is wrong with arguments.
local function is_quick(s, p)
    if type(s) ~= "string" or type(p) ~= "string" then
        return true
    end
    local cost = cost_of(p)
    return afford((#s + 1.0 + cost[1]) ^ cost[1] * cost[2])
end

local function text(value)
    return math_type(value) and value .. "" or value
end

-- -- patterns as lists of items -----------------------------------------------------------------

local function class_end(p, at)
    local c = sub(p, at, at)
    at = at + 1
    if c == "%" then
        if at > #p then
            fail("malformed pattern (ends with '%')")
        end
        return at + 1
    elseif c == "[" then
        if sub(p, at, at) == "^" then
            at = at + 1
        end
        repeat
            if at > #p then
                fail("malformed pattern (missing ']')")
            end
            at = at + (sub(p, at, at) == "%" and at < #p and 2 or 1)
        until sub(p, at, at) == "]"
        return at + 1
    end
    return at
end

-- The bytes that an item fits, as the original has it.
local function set_of(item)
    if #item == 1 and item ~= "." then
        return { [byte(item)] = true }
    end
    local found = {}
    for code = 0, 255 do
        if find(char(code), item) then
            found[code] = true
        end
    end
    return found
end

local function compiled(p, at)
    local items, size = {}, #p
    while at <= size do
        local c, after = sub(p, at, at), sub(p, at + 1, at + 1)
        local item
        if c == "(" then
            item = { kind = after == ")" and "place" or "open" }
            at = at + (after == ")" and 2 or 1)
        elseif c == ")" then
            item, at = { kind = "close" }, at + 1
        elseif c == "$" and at == size then
            item, at = { kind = "end" }, at + 1
        elseif c == "%" and after == "b" then
            if at + 3 > size then
                fail("malformed pattern (missing arguments to '%b')")
            end
            item, at = { kind = "balance", first = byte(p, at + 2), last = byte(p, at + 3) }, at + 4
        elseif c == "%" and after == "f" then
            if sub(p, at + 2, at + 2) ~= "[" then
                fail("missing '[' after '%f' in pattern")
            end
            local past = class_end(p, at + 2)
            item, at = { kind = "frontier", set = set_of(sub(p, at + 2, past - 1)) }, past
        elseif c == "%" and find(after, "^%d") then
            item, at = { kind = "back", index = byte(after) - 48 }, at + 2
        else
            local past = class_end(p, at)
            local how = sub(p, past, past)
            local repeated = how ~= "" and find("*+-?", how, 1, true)
            item = { kind = repeated and how or "one", set = set_of(sub(p, at, past - 1)) }
            at = repeated and past + 1 or past
        end
        items[#items + 1] = item
    end
    return items
end

-- -- matching -----------------------------------------------------------------------------------

local OPEN, PLACE = -1, -2

-- A function that matches a text from a place on, and one that gives what was captured then.
local function matcher(items, s)
    local size, level, starts, lengths = #s, 0, {}, {}
    local step

    local function longest(set, i, pos, least)
        local count = 0
        while set[byte(s, pos + count)] do
            count = count + 1
        end
        for some = count, least, -1 do
            local past = step(i, pos + some)
            if past then
                return past
            end
        end
    end

    local function shortest(set, i, pos)
        while true do
            local past = step(i, pos)
            if past then
                return past
            end
            if not set[byte(s, pos)] then
                return nil
            end
            pos = pos + 1
        end
    end

    local function begin(i, pos, length)
        if level >= MOST_CAPTURES then
            fail("too many captures")
        end
        level = level + 1
        starts[level], lengths[level] = pos, length
        local past = step(i, pos)
        if not past then
            level = level - 1
        end
        return past
    end

    local function finish(i, pos)
        local l = level
        while l > 0 and lengths[l] ~= OPEN do
            l = l - 1
        end
        if l == 0 then
            fail("invalid pattern capture")
        end
        lengths[l] = pos - starts[l]
        local past = step(i, pos)
        if not past then
            lengths[l] = OPEN
        end
        return past
    end

    local function balance(item, pos)
        if byte(s, pos) ~= item.first then
            return nil
        end
        local depth = 1
        for at = pos + 1, size do
            local c = byte(s, at)
            if c == item.last then
                depth = depth - 1
                if depth == 0 then
                    return at + 1
                end
            elseif c == item.first then
                depth = depth + 1
            end
        end
    end

    local function back(item, pos)
        local l = item.index
        if l < 1 or l > level or lengths[l] == OPEN then
            fail("invalid capture index %" .. l)
        end
        local length = lengths[l]
        local from = starts[l]
        if length >= 0 and size - pos + 1 >= length
            and sub(s, from, from + length - 1) == sub(s, pos, pos + length - 1) then
            charge(length // 8)
            return pos + length
        end
    end

    function step(i, pos)
        while true do
            local item = items[i]
            if item == nil then
                return pos
            end
            local kind, set = item.kind, item.set
            i = i + 1
            if kind == "one" then
                if not set[byte(s, pos)] then
                    return nil
                end
                pos = pos + 1
            elseif kind == "*" then
                return longest(set, i, pos, 0)
            elseif kind == "+" then
                return longest(set, i, pos, 1)
            elseif kind == "-" then
                return shortest(set, i, pos)
            elseif kind == "?" then
                if set[byte(s, pos)] then
                    local past = step(i, pos + 1)
                    if past then
                        return past
                    end
                end
            elseif kind == "open" then
                return begin(i, pos, OPEN)
            elseif kind == "place" then
                return begin(i, pos, PLACE)
            elseif kind == "close" then
                return finish(i, pos)
            elseif kind == "end" then
                return pos > size and pos or nil
            elseif kind == "frontier" then
                if set[pos > 1 and byte(s, pos - 1) or 0] or not set[byte(s, pos) or 0] then
                    return nil
                end
            else
                pos = (kind == "balance" and balance or back)(item, pos)
                if pos == nil then
                    return nil
                end
            end
        end
    end

    local function captured(l, from, past)
        if l > level then
            if l ~= 1 then
                fail("invalid capture index %" .. l)
            end
            return sub(s, from, past - 1)
        elseif lengths[l] == PLACE then
            return starts[l]
        elseif lengths[l] == OPEN then
            fail("unfinished capture")
        end
        return sub(s, starts[l], starts[l] + lengths[l] - 1)
    end

    local function try(pos)
        level = 0
        return step(1, pos)
    end

    -- All of them; without any the whole, or nothing where that is not wanted.
    local function captures(from, past, whole)
        local found = {}
        local count = level
        if count == 0 and whole then
            count = 1
        end
        for l = 1, count do
            found[l] = captured(l, from, past)
        end
        return unpack(found, 1, count)
    end

    return try, captures, captured
end

local function begin_at(s, init)
    init = init or 1
    if init < 0 then
        init = #s + init + 1
    end
    return init < 1 and 1 or init
end

local function searched(s, p, init, is_find)
    local anchored = byte(p) == 94
    local try, captures = matcher(compiled(p, anchored and 2 or 1), s)
    for pos = init, anchored and init or #s + 1 do
        local past = try(pos)
        if past and is_find then
            return pos, past - 1, captures(pos, past, false)
        elseif past then
            return captures(pos, past, true)
        end
    end
    return nil
end

-- -- what scripts find instead of the originals -------------------------------------------------

local function looked(s, p, init, plain, original, is_find)
    s, p = text(s), text(p)
    if is_find and type(s) == "string" and type(p) == "string"
        and (plain or not find(p, "[%^%$%*%+%?%.%(%[%%%-]")) then
        charge(#s * #p // 256)
        return find(s, p, init, true)
    end
    if is_quick(s, p) then
        return original(s, p, init, plain)
    end
    init = math_type(init) and init // 1 | 0 or init and tonumber(init) // 1 | 0
    init = begin_at(s, init)
    if init > #s + 1 then
        return nil
    end
    return searched(s, p, init, is_find)
end

function string.find(s, p, init, plain)
    return looked(s, p, init, plain, find, true)
end

function string.match(s, p, init)
    return looked(s, p, init, nil, match, false)
end

function string.gmatch(s, p, init)
    s, p = text(s), text(p)
    if is_quick(s, type(p) == "string" and byte(p) == 94 and "." .. p or p) then
        return gmatch(s, p, init)
    end
    local try, captures = matcher(compiled(p, 1), s)
    local pos, last = begin_at(s, init), nil
    return function()
        while pos <= #s + 1 do
            local from, past = pos, try(pos)
            if past and past ~= last then
                pos, last = past, past
                return captures(from, past, true)
            end
            pos = pos + 1
        end
    end
end

-- The text that replaces a match.
local function replacement(repl, from, past, captures, captured)
    local kind = type(repl)
    if kind == "function" then
        return repl(captures(from, past, true))
    elseif kind == "table" then
        return repl[captured(1, from, past)]
    end
    return (gsub(repl, "%%(.?)", function(c)
        if c == "%" then
            return "%"
        elseif c == "0" then
            return captured(0, from, past)
        elseif find(c, "^%d") then
            return tostring(captured(byte(c) - 48, from, past))
        end
        fail("invalid use of '%' in replacement string")
    end))
end

function string.gsub(s, p, repl, most)
    s, p, repl = text(s), text(p), text(repl)
    local kind = type(repl)
    if is_quick(s, p) then
        return gsub(s, p, repl, most)
    elseif kind ~= "string" and kind ~= "table" and kind ~= "function" then
        return gsub("", p, repl, most) -- it says what is wrong with that
    end
    local anchored = byte(p) == 94
    local try, captures, captured = matcher(compiled(p, anchored and 2 or 1), s)
    local function capture(l, from, past)
        return l == 0 and sub(s, from, past - 1) or captured(l, from, past)
    end
    local parts, pos, copied, last, count = {}, 1, 1, nil, 0
    most = most or #s + 1
    while count < most do
        local past = try(pos)
        if past and past ~= last then
            count = count + 1
            local made = replacement(repl, pos, past, captures, capture)
            if made then
                if type(made) ~= "string" and not math_type(made) then
                    fail("invalid replacement value (a " .. type(made) .. ")")
                end
                parts[#parts + 1] = sub(s, copied, pos - 1)
                parts[#parts + 1] = made
                copied = past
            end
            pos, last = past, past
        elseif pos <= #s then
            pos = pos + 1
        else
            break
        end
        if anchored then
            break
        end
    end
    parts[#parts + 1] = sub(s, copied)
    return concat(parts), count
end
