/** What shows in the code of Apache's compiler: keys, recursion, exceptions, names of Python. */
namespace py compiled_peer

typedef i32 Index
struct Cell { 1: Index row, 2: Index column } (python.immutable = "")
struct Tree { 1: string name, 2: optional Tree left, 3: optional list<Tree> others }
struct Chain { 1: i32 value, 2: Chain& next }
struct Board {
  1: map<Cell, string> cells,
  2: set<Cell> marked,
  3: map<string, map<Cell, list<i64>>> paths,
  4: optional Tree tree
}
enum Level { LOW = 1, HIGH = 5 }
union Reading { 1: double number, 2: string text, 3: Cell cell }
const map<string, Level> LEVELS = {"low": Level.LOW}
exception Refused { 1: string why, 2: Level level = Level.HIGH }
exception Gone { 1: Cell where }

service Root { string ping() }
service Peer extends Root {
  Board echo(1: Board board),
  Tree mirror(1: Tree tree),
  Chain follow(1: Chain chain),
  Reading read(1: Reading reading),
  string get(1: string key) throws (1: Refused refused, 2: Gone gone),
  void put(1: string key, 2: string value) throws (1: Refused refused),
  map<Cell, Level> levels(1: Level lowest),
  bool match(1: bool type),
  string str(1: string len, 2: string object),
  i32 id(1: i32 dict, 2: i32 int),
  oneway void fire(1: string what),
  list<string> fired(),
  i64 close(1: i64 connect),
}
