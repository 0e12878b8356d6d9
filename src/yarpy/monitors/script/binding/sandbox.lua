-- The limits of a script: how long one call may take, and what it may not reach.
--
-- A call runs in a coroutine with a count hook; the thread that starts it has none, so it always
-- regains control. Once the limit is passed the hook raises at every instruction outside this file,
-- which no pcall survives. Python is out of reach. Memory is counted by lupa.
-- No instruction and no library function may take longer than it takes to go through the memory of
-- a script: `guard` replaces those that would, and charges for what they do. A call that is slow for
-- its instructions, with long strings, is ended by the processor time of its thread.
-- A hook runs without a hook: in it, nothing is used that a script could have replaced, not even
-- the methods of strings.

-- With FOLDER, its modules are the only files within reach: `read` gives their text.
local LIMIT, SECONDS, UNWATCHED, thread_time, read, FOLDER = ...
local STEP = 250
local SMALL = 25 -- once a call is slow for its instructions

local create, resume, yield = coroutine.create, coroutine.resume, coroutine.yield
local sethook, traceback, getinfo = debug.sethook, debug.traceback, debug.getinfo
local pcall, error, type, tostring, select = pcall, error, type, tostring, select
local rawsetmetatable, load, loadfile = setmetatable, load, loadfile
local pack, unpack, find, sub = table.pack, table.unpack, string.find, string.sub
local time, clock, rawget, getmeta = os.time, os.clock, rawget, debug.getmetatable
local tonumber, math_type = tonumber, math.type

local used = 0
local unwatched = 0 -- steps that library functions may still take uncounted
local began = 0 -- the call, in whole seconds: what is quick to ask
-- Once a call has lasted so long that it matters, the processor time of all threads, which is quick
-- to ask, and of this one.
local late, own = nil, nil
local DONE = {}

-- Whether a library function may take so many steps, at its worst, that are not counted.
local function afford(steps)
    if steps > unwatched then
        return false
    end
    unwatched = unwatched - steps
    return true
end

-- An error at the line of the script; our own sources are called =something.
local function fail(problem)
    local level = 2
    local info = getinfo(level, "Sl")
    while info and (info.currentline < 0 or sub(info.source, 1, 1) == "=") do
        level = level + 1
        info = getinfo(level, "Sl")
    end
    if info then
        problem = info.short_src .. ":" .. info.currentline .. ": " .. problem
    end
    error(problem, 0)
end

local tick, small_tick

local function check()
    local why
    if used > LIMIT then
        why = LIMIT .. " instructions"
    elseif time() - began >= 1 then
        if late == nil then
            late, own = clock(), thread_time()
            sethook(small_tick, "", SMALL)
        elseif clock() - late > SECONDS and thread_time() - own > SECONDS then
            used = LIMIT + 1
            why = SECONDS .. " seconds"
        end
    end
    if why then
        sethook(small_tick, "", 1)
        fail("it runs for more than " .. why .. " in one call")
    end
end

function tick()
    used = used + STEP
    check()
end

function small_tick()
    used = used + SMALL
    check()
end

-- Count what a library function is going to do as instructions.
local function charge(count)
    if count > 0 then
        used = used + count
        if used > LIMIT then
            sethook(small_tick, "", 1)
            fail("it does more than " .. LIMIT .. " steps in one call")
        end
    end
end

-- -- what scripts find instead of the originals --------------------------------------------------

function coroutine.create(f)
    used = used + STEP
    local made = create(f)
    sethook(made, tick, "", STEP)
    return made
end

local function passed(ok, ...)
    if not ok then
        error((...), 0)
    end
    return ...
end

function coroutine.wrap(f)
    local made = coroutine.create(f)
    return function(...)
        return passed(resume(made, ...))
    end
end

-- The original would run its handler with hooks switched off.
function xpcall(f, handler, ...)
    local results = pack(pcall(f, ...))
    if results[1] then
        return unpack(results, 1, results.n)
    end
    return false, handler(results[2])
end

-- So would a finaliser.
function setmetatable(object, meta)
    if type(meta) == "table" and rawget(meta, "__gc") ~= nil then
        fail("__gc is not available in a monitor")
    end
    return rawsetmetatable(object, meta)
end

-- Reading a source takes longer than an instruction.
function _G.load(chunk, name, _, ...)
    local given = chunk
    if type(given) == "string" then
        charge(8 * #given)
    elseif type(given) == "function" then
        chunk = function()
            local piece = given()
            charge(type(piece) == "string" and 8 * #piece or 0)
            return piece
        end
    end
    return load(chunk, name, "t", ...)
end

function _G.loadfile(name, _, ...)
    return loadfile(name, "t", ...)
end

function dofile(name)
    return assert(loadfile(name, "t"))()
end

function os.exit()
    fail("a monitor cannot end the program")
end

loadstring = _G.load -- the name in older scripts
_G.unpack = unpack
debug = { traceback = traceback }
package.loaded.debug = debug
package.loadlib = nil
package.cpath = ""
python = nil
package.loaded.python = nil

if FOLDER then
    local loaded = package.loaded
    os = { time = os.time, clock = os.clock, date = os.date, difftime = os.difftime }
    io, dofile, _G.loadfile = nil, nil, nil
    loaded.io, loaded.os, loaded.package = nil, os, nil
    package = { loaded = loaded }

    function require(name)
        local made = loaded[name]
        if made == nil then
            if type(name) ~= "string" or not find(name, "^[%w_]+$") then
                fail("a module must have a plain name and be in the script's folder")
            end
            local path = FOLDER .. "/" .. name .. ".lua"
            local problem, source = read(path)
            local chunk = nil
            if not problem then
                chunk, problem = load(source, "@" .. path, "t")
            end
            if not chunk then
                fail("module '" .. name .. "' not found beside the script: " .. problem)
            end
            made = chunk(name)
            if made == nil then
                made = true
            end
            loaded[name] = made
        end
        return made
    end
end

-- -- library functions whose time has no limit ---------------------------------------------------

-- The length of a table that a library function goes through.
local function length(object)
    if type(object) ~= "table" then
        return 0 -- the function says what is wrong with that
    end
    local meta = getmeta(object)
    if meta and rawget(meta, "__len") ~= nil then
        fail("a table with __len cannot be given to this function")
    end
    return #object
end

-- Replace them. The bindings, which are loaded before, have the originals.
local function guard()
    local insert, remove, concat, sort = table.insert, table.remove, table.concat, table.sort
    local move, rep, log = table.move, string.rep, math.log

    function table.insert(t, ...)
        if select("#", ...) > 1 then
            charge(length(t) // 4)
        end
        return insert(t, ...)
    end

    function table.remove(t, ...)
        if select("#", ...) > 0 then
            charge(length(t) // 4)
        end
        return remove(t, ...)
    end

    function table.concat(t, between, i, j)
        charge((tonumber(j) or length(t)) - (tonumber(i) or 1))
        return concat(t, between, i, j)
    end

    function table.sort(t, before)
        local count = length(t)
        charge(count * (log(count + 1, 2) // 1 | 0))
        return sort(t, before)
    end

    function table.move(from, first, last, ...)
        charge((tonumber(last) or 0) - (tonumber(first) or 0))
        return move(from, first, last, ...)
    end

    function string.rep(s, count, between)
        local times = tonumber(count) or 0
        charge(times)
        local size = (type(s) == "string" and #s or 1) + (type(between) == "string" and #between or 1)
        charge(times * size // 256)
        return rep(s, count, between)
    end

end

-- -- running ------------------------------------------------------------------------------------

local function loop(f, ...)
    return loop(yield(DONE, f(...)))
end

local idle

local function described(problem)
    if type(problem) == "string" then
        return problem
    end
    return "an error that is a " .. type(problem)
end

local function back(worker, ok, mark, ...)
    if not ok then
        return false, described(mark)
    end
    if mark ~= DONE then
        return false, "it yields outside of a coroutine"
    end
    idle = worker
    return true, ...
end

-- run(f, ...): true and the results of f, or false and a message.
local function run(f, ...)
    local worker = idle
    idle = nil
    used, unwatched, began, late = 0, UNWATCHED, time(), nil
    if worker == nil then
        worker = create(loop)
        sethook(worker, tick, "", STEP)
    end
    return back(worker, resume(worker, f, ...))
end

return run, fail, guard, charge, afford
