// A port of C++ YARP with every carrier that its package brings, and a value of every type.
//
//     open NAME          the port is open: "done"
//     join CARRIER A B   "done", or "failed"
//     wait               "done", once the port has a connection that it knows of
//     send TYPE          what is sent, as `read` shows it
//     read TYPE          what came, once it has
//
// One line in, one line out; what C++ prints itself goes to standard error.

#include <yarp/os/all.h>
#include <yarp/sig/all.h>

#include <cstdio>
#include <iostream>
#include <sstream>
#include <string>
#include <unistd.h>


using namespace yarp::os;
using namespace yarp::sig;

template <class T>
std::string pixels(ImageOf<T>& image)
{
    std::ostringstream text;
    text << image.width() << "x" << image.height();
    for (size_t y = 0; y < image.height(); y++) {
        const unsigned char* row = image.getRow(y);
        for (size_t at = 0; at < image.width() * sizeof(T); at++) {
            text << " " << int(row[at]);
        }
    }
    return text.str();
}

template <class T>
void paint(ImageOf<T>& image)
{
    image.resize(5, 3);
    for (size_t y = 0; y < 3; y++) {
        for (size_t at = 0; at < 5 * sizeof(T); at++) {
            image.getRow(y)[at] = static_cast<unsigned char>(10 * y + at);
        }
    }
}

std::string samples(Sound& sound)
{
    std::ostringstream text;
    text << sound.getFrequency();
    for (size_t channel = 0; channel < sound.getChannels(); channel++) {
        for (size_t at = 0; at < sound.getSamples(); at++) {
            text << " " << int(sound.get(at, channel));
        }
    }
    return text.str();
}

// Each type: how to fill one, and how to show it.
void fill(Bottle& value) { value.fromString("1 -2.5 word \"two words\" [set] (3 (deep) ()) {98 0}"); }
std::string show(Bottle& value) { return value.toString(); }
void fill(Value& value) { value = Value("two words"); }
std::string show(Value& value) { return value.toString(); }
void fill(Property& value)
{
    value.put("a", 5);
    value.put("b", 2.5);
    value.put("s", "x y");
}
std::string show(Property& value)
{
    std::ostringstream text;
    text << value.find("a").asInt32() << " " << value.find("b").asFloat64() << " "
         << value.find("s").asString();
    return text.str();
}
void fill(Stamp& value) { value = Stamp(7, 5.25); }
std::string show(Stamp& value)
{
    return std::to_string(value.getCount()) + " " + std::to_string(value.getTime());
}
void fill(Vector& value) { value = Vector{0.5, -2.5, 0.25}; }
std::string show(Vector& value) { return value.toString(2); }
void fill(VectorOf<int>& value) { value = VectorOf<int>{5, -6}; }
std::string show(VectorOf<int>& value) { return value.toString(); }
void fill(Matrix& value)
{
    value.resize(2, 3);
    for (int at = 0; at < 6; at++) {
        value(at / 3, at % 3) = at / 8.0;
    }
}
std::string show(Matrix& value)
{
    std::ostringstream text;
    text << value.rows() << "x" << value.cols();
    for (size_t at = 0; at < value.rows() * value.cols(); at++) {
        text << " " << value(at / value.cols(), at % value.cols());
    }
    return text.str();
}
template <class T>
void fill(ImageOf<T>& value) { paint(value); }
template <class T>
std::string show(ImageOf<T>& value) { return pixels(value); }
void fill(Sound& value)
{
    value.resize(3, 2);
    value.setFrequency(44100);
    for (int at = 0; at < 6; at++) {
        value.set(100 * at - 250, at % 3, at / 3);
    }
}
std::string show(Sound& value) { return samples(value); }

std::string line(std::string text)
{
    for (auto& c : text) {
        c = c == '\n' ? ' ' : c;
    }
    return text;
}

template <class T>
std::string carry_out(Port& port, bool sends)
{
    T value;
    if (sends) {
        fill(value);
        return port.write(value) ? line(show(value)) : "failed";
    }
    return port.read(value) ? line(show(value)) : "failed";
}

std::string carry_out(Port& port, bool sends, const std::string& type)
{
    if (type == "Bottle") { return carry_out<Bottle>(port, sends); }
    if (type == "Value") { return carry_out<Value>(port, sends); }
    if (type == "Property") { return carry_out<Property>(port, sends); }
    if (type == "Stamp") { return carry_out<Stamp>(port, sends); }
    if (type == "Vector") { return carry_out<Vector>(port, sends); }
    if (type == "VectorInt") { return carry_out<VectorOf<int>>(port, sends); }
    if (type == "Matrix") { return carry_out<Matrix>(port, sends); }
    if (type == "ImageRgb") { return carry_out<ImageOf<PixelRgb>>(port, sends); }
    if (type == "ImageMono") { return carry_out<ImageOf<PixelMono>>(port, sends); }
    if (type == "Sound") { return carry_out<Sound>(port, sends); }
    return "failed: unknown type";
}

std::string wait_for_connection(Port& port)
{
    for (int left = 3000; left > 0; left--) {
        if (port.getInputCount() + port.getOutputCount() > 0) { return "done"; }
        SystemClock::delaySystem(0.01);
    }
    return "failed";
}

int main()
{
    FILE* answers = fdopen(dup(1), "w");
    dup2(2, 1);
    Network network(YARP_CLOCK_SYSTEM);
    add_plugins();
    Port port;
    std::string text;
    while (std::getline(std::cin, text)) {
        std::istringstream words(text);
        std::string verb, a, b, c;
        words >> verb >> a >> b >> c;
        std::string answer = "failed: unknown verb";
        if (verb == "open") { answer = port.open(a) ? "done" : "failed"; }
        if (verb == "join") { answer = Network::connect(b, c, a) ? "done" : "failed"; }
        if (verb == "wait") { answer = wait_for_connection(port); }
        if (verb == "send") { answer = carry_out(port, true, a); }
        if (verb == "read") { answer = carry_out(port, false, a); }
        fprintf(answers, "%s\n", answer.c_str());
        fflush(answers);
    }
    return 0;
}
