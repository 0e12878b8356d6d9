enum Mode { AUTO = 0, MANUAL = 7 }
struct Inner { 1: i32 x = 3, 2: optional string note }
union Shape { 1: i32 side, 2: double radius }
exception Bad { 1: i32 code, 2: string message }
exception Worse { 1: string why }
struct All {
  1: bool a, 2: byte b, 3: i16 c, 4: i32 d, 5: i64 e, 6: double f, 7: string g, 8: binary h,
  9: list<i32> i, 10: set<string> j, 11: map<string, i64> k, 12: Mode l, 13: Inner m,
  14: list<Inner> n, 15: map<i32, list<double>> o, 16: Shape p, 17: list<bool> q,
  18: optional i32 r, 19: optional Inner s, 40: required i16 t = 5, 21: list<Mode> u,
  22: list<list<string>> v, 23: list<byte> w, 24: list<i64> y
}
service Base { string ping() }
service Test extends Base {
  All echo(1: All all) throws (1: Bad bad),
  i32 add(1: i32 a, 2: i32 b = 10),
  bool is_on(3: bool value),
  void nothing(),
  oneway void fire(1: string what),
  string fail(1: i32 how) throws (1: Bad bad, 4: Worse worse),
  string missing(),
  list<double> numbers(1: i32 count),
}
