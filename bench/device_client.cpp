// A client of C++ YARP for bench/device_peers.py: it times one call, and the age of what streams in.
//
//     client --ask battery --calls 1000 --seconds 2 --device battery_nwc_yarp --remote /there ...
//
// prints "call US" (median of a call in microseconds) and "stream HZ US" (how many new values came a
// second, and the median age at which they were seen), or "refused".
//
// Rules: YARP 3.9 and 4.0 from the same lines; what only one of them has stands in an #if.
#include <yarp/conf/version.h>
#include <yarp/dev/IAudioGrabberSound.h>
#include <yarp/dev/IBattery.h>
#include <yarp/dev/IChatBot.h>
#include <yarp/dev/IControlLimits.h>
#include <yarp/dev/IEncodersTimed.h>
#include <yarp/dev/IFrameGrabberImage.h>
#include <yarp/dev/IFrameTransform.h>
#include <yarp/dev/IJoypadController.h>
#include <yarp/dev/ILLM.h>
#include <yarp/dev/ILocalization2D.h>
#include <yarp/dev/IMap2D.h>
#include <yarp/dev/INavigation2D.h>
#include <yarp/dev/IPreciselyTimed.h>
#include <yarp/dev/IRGBDSensor.h>
#include <yarp/dev/IRangefinder2D.h>
#include <yarp/dev/IRgbVisualParams.h>
#include <yarp/dev/IRobotDescription.h>
#include <yarp/dev/ISerialDevice.h>
#include <yarp/dev/ISpeechSynthesizer.h>
#include <yarp/dev/ISpeechTranscription.h>
#include <yarp/dev/MultipleAnalogSensorsInterfaces.h>
#include <yarp/dev/PolyDriver.h>
#include <yarp/os/Network.h>
#include <yarp/os/Property.h>
#include <yarp/os/Stamp.h>
#include <yarp/os/Time.h>
#if YARP_VERSION_MAJOR >= 4
#include <yarp/dev/IOdometry2D.h>
#include <yarp/dev/ISimulatedWorld.h>
#else
#include <yarp/dev/IAnalogSensor.h>
#endif

#include <algorithm>
#include <chrono>
#include <functional>
#include <iostream>
#include <map>
#include <string>
#include <vector>

using namespace yarp::dev;
using Driver = PolyDriver;

// Whether it was answered; when the last value was made, seconds, 0 for none.
using Call = std::function<bool(Driver&)>;
using Seen = std::function<double(Driver&)>;
struct Row {
    Call call;
    Seen seen;
};

template <class View, class Function>
auto through(Function function) {
    return [function](Driver& driver) {
        View* view = nullptr;
        return driver.view(view) ? function(*view) : decltype(function(*view))();
    };
}

static double pictured(Driver& driver) {
    IFrameGrabberImage* camera = nullptr;
    IPreciselyTimed* timed = nullptr;
    yarp::sig::ImageOf<yarp::sig::PixelRgb> picture;
    if (!driver.view(camera) || !driver.view(timed) || !camera->getImage(picture)) return 0.0;
    return timed->getLastInputStamp().getTime();
}

static std::map<std::string, Row> rows() {
    std::map<std::string, Row> all;
    all["board"] = {
        through<IControlLimits>([](auto& v) {
            double least, most;
#if YARP_VERSION_MAJOR >= 4
            return bool(v.getPosLimits(0, &least, &most));
#else
            return bool(v.getLimits(0, &least, &most));
#endif
        }),
        through<IEncodersTimed>([](auto& v) {
            std::vector<double> where(64), when(64);
            return v.getEncodersTimed(where.data(), when.data()) ? when[0] : 0.0;
        })};
    all["camera"] = {
        through<IRgbVisualParams>([](auto& v) {
            int width, height;
            return bool(v.getRgbResolution(width, height));
        }),
        pictured};
    all["depth"] = {
        through<IDepthVisualParams>([](auto& v) {
            double nearest, farthest;
            return bool(v.getDepthClipPlanes(nearest, farthest));
        }),
        through<IRGBDSensor>([](auto& v) {
            yarp::sig::FlexImage picture;
            yarp::os::Stamp stamp;
            return v.getRgbImage(picture, &stamp) ? stamp.getTime() : 0.0;
        })};
    all["battery"] = {
        through<IBattery>([](auto& v) {
            std::string info;
            return bool(v.getBatteryInfo(info));
        }),
        nullptr};
    all["laser"] = {
        through<IRangefinder2D>([](auto& v) {
            double nearest, farthest;
            return bool(v.getDistanceRange(nearest, farthest));
        }),
        through<IRangefinder2D>([](auto& v) {
            yarp::sig::Vector ranges;
            double when = 0;
            return v.getRawData(ranges, &when) ? when : 0.0;
        })};
    all["sensors"] = {
        nullptr,
        through<IThreeAxisGyroscopes>([](auto& v) {
            yarp::sig::Vector value;
            double when = 0;
            return v.getThreeAxisGyroscopeMeasure(0, value, when) ? when : 0.0;
        })};
    all["frames"] = {
        through<IFrameTransform>([](auto& v) {
            yarp::sig::Matrix pose(4, 4);
            pose.eye();
            return bool(v.setTransform("head", "base", pose));
        }),
        nullptr};
    all["joypad"] = {
        through<IJoypadController>([](auto& v) {
#if YARP_VERSION_MAJOR >= 4
            size_t count;
#else
            unsigned int count;
#endif
            return bool(v.getButtonCount(count));
        }),
        nullptr};
    all["microphone"] = {
        through<IAudioGrabberSound>([](auto& v) {
            bool recording;
            return bool(v.isRecording(recording));
        }),
        nullptr};
    all["localization"] = {
        through<Nav2D::ILocalization2D>([](auto& v) {
            Nav2D::LocalizationStatusEnum status;
            return bool(v.getLocalizationStatus(status));
        }),
        nullptr};
    all["navigation"] = {
        through<Nav2D::INavigation2D>([](auto& v) {
            Nav2D::NavigationStatusEnum status;
            return bool(v.getNavigationStatus(status));
        }),
        nullptr};
    all["base"] = {
        through<Nav2D::INavigation2DVelocityActions>([](auto& v) {
            double x, y, theta;
            return bool(v.getLastVelocityCommand(x, y, theta));
        }),
        nullptr};
    all["maps"] = {
        through<Nav2D::IMap2D>([](auto& v) {
            std::vector<std::string> names;
            return bool(v.get_map_names(names));
        }),
        nullptr};
    all["robot"] = {
        through<IRobotDescription>([](auto& v) {
            std::vector<DeviceDescription> found;
            return bool(v.getAllDevices(found));
        }),
        nullptr};
    all["serial"] = {
        through<ISerialDevice>([](auto& v) { return bool(v.setDTR(true)); }), nullptr};
    all["voice"] = {
        through<ISpeechSynthesizer>([](auto& v) {
            std::string language;
            return bool(v.getLanguage(language));
        }),
        nullptr};
    all["ear"] = {
        through<ISpeechTranscription>([](auto& v) {
            std::string language;
            return bool(v.getLanguage(language));
        }),
        nullptr};
    all["chat"] = {
        through<IChatBot>([](auto& v) {
            std::string language;
            return bool(v.getLanguage(language));
        }),
        nullptr};
    all["model"] = {
        through<ILLM>([](auto& v) {
#if YARP_VERSION_MAJOR >= 4
            std::vector<LLM_Message> said;
#else
            std::vector<std::pair<Author, Content>> said;
#endif
            return bool(v.getConversation(said));
        }),
        nullptr};
#if YARP_VERSION_MAJOR >= 4
    all["odometry"] = {
        through<Nav2D::IOdometry2D>([](auto& v) { return bool(v.resetOdometry()); }),
        through<Nav2D::IOdometry2D>([](auto& v) {
            OdometryData found;
            double when = 0;
            return v.getOdometry(found, &when) ? when : 0.0;
        })};
    all["world"] = {
        through<ISimulatedWorld>([](auto& v) {
            std::vector<std::string> names;
            return bool(v.getList(names));
        }),
        nullptr};
#else
    all["channels"] = {
        through<IAnalogSensor>([](auto& v) {
            return v.calibrateChannel(0) == IAnalogSensor::AS_OK;
        }),
        nullptr};
#endif
    return all;
}

static double median(std::vector<double> values) {
    std::nth_element(values.begin(), values.begin() + values.size() / 2, values.end());
    return values[values.size() / 2];
}

static double now() {
    using namespace std::chrono;
    return duration<double>(steady_clock::now().time_since_epoch()).count();
}

static bool measure(const Row& row, Driver& driver, int calls, double seconds) {
    if (row.call) {
        std::vector<double> took;
        for (int at = 0; at < calls; at++) {
            double begin = now();
            if (!row.call(driver)) return false;
            took.push_back(now() - begin);
        }
        std::cout << "call " << median(took) * 1e6 << std::endl;
    }
    if (row.seen) {
        std::vector<double> ages;
        double last = 0, first = 0, latest = 0;
        for (double end = now() + seconds; now() < end; yarp::os::Time::delay(0.0002)) {
            double when = row.seen(driver);
            if (when == last || when == 0) continue;
            last = when;
            latest = now();
            if (first == 0) first = latest;
            ages.push_back(yarp::os::Time::now() - when);
        }
        if (ages.size() >= 3) {  // otherwise it does not say when
            std::cout << "stream " << (ages.size() - 1) / (latest - first) << ' '
                      << median(ages) * 1e6 << std::endl;
        }
    }
    return true;
}

int main(int argc, char* argv[]) {
    yarp::os::Network network;
    add_plugins();
    yarp::os::Property options;
    options.fromCommand(argc, argv);
    Driver driver;
    auto all = rows();
    auto row = all.find(options.find("ask").asString());
    if (row == all.end() || !driver.open(options)) {
        std::cout << "not available" << std::endl;
        return 1;
    }
    yarp::os::Time::delay(1.0);  // the first messages of a stream
    bool done = measure(row->second, driver, options.find("calls").asInt32(),
                        options.find("seconds").asFloat64());
    std::cout << (done ? "done" : "refused") << std::endl;
    return done ? 0 : 1;
}
