-- The limits of a script: how long one call may take, and what it may not reach.
--
-- A call runs in a coroutine with a count hook; the thread that starts it has none, so it always
-- regains control. Once the limit is passed the hook raises at every instruction outside this file,
-- which no pcall survives. Python is out of reach.
-- Time inside a single library function is not counted; memory is (by lupa).

local LIMIT, FOLDER = ... -- with FOLDER, its modules are the only files within reach
local STEP = 1000

local create, resume, yield = coroutine.create, coroutine.resume, coroutine.yield
local sethook, traceback, getinfo = debug.sethook, debug.traceback, debug.getinfo
local pcall, error, type, tostring, select = pcall, error, type, tostring, select
local rawget, rawsetmetatable, load, loadfile = rawget, setmetatable, load, loadfile
local pack, unpack, find = table.pack, table.unpack, string.find

local used = 0
local DONE = {}

-- An error at the line of the script; our own sources are called =something.
local function fail(problem)
    local level = 2
    local info = getinfo(level, "Sl")
    while info and (info.currentline < 0 or info.source:sub(1, 1) == "=") do
        level = level + 1
        info = getinfo(level, "Sl")
    end
    if info then
        problem = info.short_src .. ":" .. info.currentline .. ": " .. problem
    end
    error(problem, 0)
end

local function tick()
    used = used + STEP
    if used > LIMIT then
        sethook(tick, "", 1)
        fail("it runs for more than " .. LIMIT .. " instructions in one call")
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

function _G.load(chunk, name, _, ...)
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
            local chunk, problem = loadfile(FOLDER .. "/" .. name .. ".lua", "t")
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
    used = 0
    if worker == nil then
        worker = create(loop)
        sethook(worker, tick, "", STEP)
    end
    return back(worker, resume(worker, f, ...))
end

return run, fail
