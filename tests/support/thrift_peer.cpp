// A server of capt.thrift that gives back what it gets, and a client that calls it.
#include <cstdio>
#include <iostream>
#include <yarp/os/Network.h>
#include <yarp/os/RpcServer.h>
#include <yarp/os/RpcClient.h>
#include <yarp/os/Time.h>
#include "Capt.h"

using namespace std;
#define ECHO(type, name) type name(const type& v) override { return v; }

class Echo : public Capt {
public:
    int32_t add(const int32_t a, const int32_t b) override { return a + b; }
    int8_t r_i8(const int8_t v) override { return v; }
    int16_t r_i16(const int16_t v) override { return v; }
    int32_t r_i32(const int32_t v) override { return v; }
    int64_t r_i64(const int64_t v) override { return v; }
    double r_double(const double v) override { return v; }
    yarp::conf::float32_t r_float32(const yarp::conf::float32_t v) override { return v; }
    uint8_t r_ui8(const uint8_t v) override { return v; }
    yarp::conf::vocab32_t r_vocab(const yarp::conf::vocab32_t v) override { return v; }
    bool r_bool(const bool v) override { return v; }
    Color r_enum(const Color v) override { return v; }
    ECHO(string, r_string)
    ECHO(string, r_binary)
    ECHO(vector<int32_t>, r_lint)
    ECHO(vector<string>, r_lstring)
    ECHO(vector<double>, r_ldouble)
    ECHO(vector<Color>, r_lenum)
    ECHO(vector<vector<int32_t>>, r_llist)
    ECHO(set<int32_t>, r_set)
    map<string, int32_t> r_mint(const map<string, int32_t>& v) override { return v; }
    map<string, Point> r_mstruct(const map<string, Point>& v) override { return v; }
    ECHO(vector<Point>, r_lstruct)
    ECHO(Point, r_struct)
    ECHO(Nest, r_nest)
    ECHO(Prims, r_prims)
    ECHO(One, r_one)
    ECHO(Anno, r_anno)
    void no_result(const string& text) override { cout << "no_result " << text << endl; }
    void nothing() override { cout << "nothing" << endl; }
    int32_t noargs() override { return 77; }
    void fire(const int32_t x) override { cout << "fire " << x << endl; }
    bool check_defaults(const int32_t x) override { return x == 42; }
    string tail_defaults(const int32_t first, const Color c, const int32_t n, const string& s) override
    { return to_string(first) + " " + to_string((int)c) + " " + to_string(n) + " " + s; }
    int32_t get_long_method_name(const int32_t a, const string& b) override { return a + b.size(); }
    bool const_method() const override { return true; }
};

int main(int argc, char* argv[])
{
    yarp::os::Network network;
    string mode = argv[1], name = argv[2];
    if (mode == "server") {
        Echo echo;
        yarp::os::RpcServer port;
        echo.yarp().attachAsServer(port);
        port.open(name);
        cout << "ready" << endl;
        while (true) { yarp::os::Time::delay(1); }
    }
    yarp::os::RpcClient port;
    port.open("...");
    if (!yarp::os::Network::connect(port.getName(), name)) { return 1; }
    Capt capt;
    capt.yarp().attachAsClient(port);
    cout << "add " << capt.add(2, 40) << endl;
    cout << "numbers " << (int)capt.r_i8(-7) << " " << capt.r_i16(-300) << " " << capt.r_i64(5000000000) << " "
         << capt.r_double(3.25) << " " << capt.r_float32(1.5f) << " " << (int)capt.r_ui8(200) << endl;
    cout << "words " << capt.r_string("two words") << " " << capt.r_bool(true) << capt.r_bool(false) << " "
         << capt.r_enum(DARK_BLUE) << " " << capt.r_binary(string("\0\1", 2)).size() << endl;
    cout << "lists " << capt.r_lint({1, 2, 3}).size() << " " << capt.r_lstring({"a", "b c"})[1] << " "
         << capt.r_ldouble({1.5, 2.5})[1] << " " << capt.r_lenum({RED, GREEN})[1] << endl;
    cout << "nested " << capt.r_llist({{1, 2}, {}, {3}}).size() << endl;
    cout << "map " << capt.r_mint({{"a", 1}, {"b", 2}})["b"] << endl;
    cout << "struct " << capt.r_struct(Point(4, 5)).toString() << endl;
    cout << "structs " << capt.r_lstruct({Point(1, 2), Point(3, 4)})[1].toString() << endl;
    cout << "mstruct " << capt.r_mstruct({{"k", Point(1, 2)}})["k"].toString() << endl;
    capt.no_result("text");
    capt.nothing();
    cout << "noargs " << capt.noargs() << endl;
    capt.fire(5);
    cout << "defaults " << capt.check_defaults() << capt.check_defaults(7) << " " << capt.tail_defaults(1) << endl;
    cout << "long " << capt.get_long_method_name(10, "abc") << " " << capt.const_method() << endl;
    cout << "done" << endl;
    return 0;
}
