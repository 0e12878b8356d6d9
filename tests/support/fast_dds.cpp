// A program of Fast DDS with std_msgs/msg/String, under the name and in the bytes of ROS 2.
//
//     peer hear TOPIC    prints what is published
//     peer say TOPIC     publishes the lines of its input
//
// The type is written by hand, so no generator is needed. Nothing leaves this computer, and the
// history keeps all; everything else is the library's default.
#include <chrono>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <iostream>
#include <string>
#include <thread>

#include <fastdds/dds/domain/DomainParticipant.hpp>
#include <fastdds/dds/domain/DomainParticipantFactory.hpp>
#include <fastdds/dds/publisher/DataWriter.hpp>
#include <fastdds/dds/publisher/Publisher.hpp>
#include <fastdds/dds/subscriber/DataReader.hpp>
#include <fastdds/dds/subscriber/SampleInfo.hpp>
#include <fastdds/dds/subscriber/Subscriber.hpp>
#include <fastdds/dds/topic/TypeSupport.hpp>
#include <fastdds/rtps/transport/UDPv4TransportDescriptor.h>
#include <fastrtps/utils/IPLocator.h>

using namespace eprosima::fastdds::dds;
using eprosima::fastrtps::rtps::InstanceHandle_t;
using eprosima::fastrtps::rtps::IPLocator;
using eprosima::fastrtps::rtps::Locator_t;
using eprosima::fastrtps::rtps::SerializedPayload_t;

struct Text : TopicDataType {
    Text() {
        setName("std_msgs::msg::dds_::String_");
        m_typeSize = 65536;
        m_isGetKeyDefined = false;
    }
    bool serialize(void* data, SerializedPayload_t* payload) override {
        const auto& text = *static_cast<std::string*>(data);
        const unsigned char little_endian[4] = {0, 1, 0, 0};
        const uint32_t size = text.size() + 1;
        if (8 + size > payload->max_size) return false;
        std::memcpy(payload->data, little_endian, 4);
        std::memcpy(payload->data + 4, &size, 4);
        std::memcpy(payload->data + 8, text.c_str(), size);
        payload->encapsulation = CDR_LE;
        payload->length = 8 + size;
        return true;
    }
    bool deserialize(SerializedPayload_t* payload, void* data) override {
        uint32_t size = 0;
        if (payload->length < 9) return false;
        std::memcpy(&size, payload->data + 4, 4);
        if (size < 1 || size > payload->length - 8) return false;
        const char* text = reinterpret_cast<const char*>(payload->data) + 8;
        static_cast<std::string*>(data)->assign(text, size - 1);
        return true;
    }
    std::function<uint32_t()> getSerializedSizeProvider(void* data) override {
        return [data] { return 9 + static_cast<std::string*>(data)->size(); };
    }
    void* createData() override { return new std::string; }
    void deleteData(void* data) override { delete static_cast<std::string*>(data); }
    bool getKey(void*, InstanceHandle_t*, bool) override { return false; }
};

int main(int, char** words) {
    DomainParticipantQos here = PARTICIPANT_QOS_DEFAULT;
    auto udp = std::make_shared<eprosima::fastdds::rtps::UDPv4TransportDescriptor>();
    udp->interfaceWhiteList.push_back("127.0.0.1");
    here.transport().use_builtin_transports = false;
    here.transport().user_transports.push_back(udp);
    for (int number = 0; number < 16; ++number) {
        Locator_t place;
        IPLocator::setIPv4(place, 127, 0, 0, 1);
        place.port = 7410 + 2 * number;
        here.wire_protocol().builtin.initialPeersList.push_back(place);
    }
    auto* part = DomainParticipantFactory::get_instance()->create_participant(0, here);
    TypeSupport type(new Text);
    type.register_type(part);
    auto* topic = part->create_topic(
        std::string("rt") + words[2], type.get_type_name(), TOPIC_QOS_DEFAULT);
    std::string line;
    if (std::string(words[1]) == "hear") {
        DataReaderQos qos = DATAREADER_QOS_DEFAULT;
        qos.reliability().kind = RELIABLE_RELIABILITY_QOS;
        qos.history().kind = KEEP_ALL_HISTORY_QOS;
        auto* reader = part->create_subscriber(SUBSCRIBER_QOS_DEFAULT)->create_datareader(topic, qos);
        std::cout << "ready" << std::endl;
        std::thread([] {
            for (std::string end; std::getline(std::cin, end);) {}
            std::_Exit(0);
        }).detach();
        for (SampleInfo info;;) {
            reader->wait_for_unread_message({1, 0});
            while (reader->take_next_sample(&line, &info) == ReturnCode_t::RETCODE_OK)
                if (info.valid_data) std::cout << line << std::endl;
        }
    }
    DataWriterQos qos = DATAWRITER_QOS_DEFAULT;
    qos.history().kind = KEEP_ALL_HISTORY_QOS;
    auto* writer = part->create_publisher(PUBLISHER_QOS_DEFAULT)->create_datawriter(topic, qos);
    std::cout << "ready" << std::endl;
    while (std::getline(std::cin, line)) writer->write(&line);
    std::this_thread::sleep_for(std::chrono::seconds(1));  // until it is acknowledged
    std::_Exit(0);
}
