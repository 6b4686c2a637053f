// Who is let in, and what one may say: real sockets, with keys in a directory of its own.
#include "nodes/runtime/security/security.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <filesystem>

#include "core/base/error.h"
#include "nodes/runtime/master_link/master_link.h"
#include "nodes/runtime/process/monotonic_clock.h"
#include "nodes/runtime/transport/socket.h"
#include "nodes/wire/envelope.h"
#include "tests/runtime/key_directory.h"
#include "tests/runtime/network_threads.h"
#include "tests/runtime/toy.h"

namespace dmise {
namespace {

using namespace test;
using testing::HasSubstr;

constexpr std::chrono::seconds patience{10};
constexpr std::chrono::milliseconds in_vain{300};  // how long what must not come is waited for

/// A server of one domain and what it hears.
struct Server {
  Server(const Keys& keys, Domain domain)
      : security(keys.directory, "server"),
        door(context, security),
        socket(make_socket(context, zmq::socket_type::router, max_control_bytes)),
        address(bind_to(socket, "tcp://127.0.0.1:0", security, domain)) {}
  /// The next message, if one comes within the time.
  std::vector<zmq::message_t> hears(std::chrono::nanoseconds within) {
    std::vector<zmq::pollitem_t> items{{socket.handle(), 0, ZMQ_POLLIN, 0}};
    wait_for(items, within);
    return receive(socket);
  }
  zmq::context_t context{1};
  Security security;
  ZapAuthenticator door;
  zmq::socket_t socket;
  std::string address;
};

struct Client {
  Client(const Server& server, const Security& security)
      : socket(make_socket(context, zmq::socket_type::dealer, max_control_bytes)) {
    connect_to(socket, server.address, security, "server");
    socket.send(zmq::str_buffer("hello"), zmq::send_flags::none);
  }
  zmq::context_t context{1};
  zmq::socket_t socket;
};

TEST(Keys, AreReadableByTheirOwnerAlone) {
  const Keys keys({"a"});
  struct stat status {};
  ASSERT_EQ(stat((keys.directory + "/a.key").c_str(), &status), 0);
  EXPECT_EQ(status.st_mode & 0777, 0600u);
  EXPECT_THROW(make_key(keys.directory, "a", false), ConfigError);  // never replaced unasked
  chmod((keys.directory + "/a.key").c_str(), 0640);
  EXPECT_THROW(read_key(keys.directory, "a"), ConfigError);
  EXPECT_THROW(read_key(keys.directory, "b"), ConfigError);
  EXPECT_THROW(make_key(keys.directory, "../b", false), ConfigError);
}

TEST(Keys, AreMadeInPairsOrNotAtAll) {
  const Keys keys({"a"});
  const std::string secret = keys.directory + "/a.key";
  ASSERT_EQ(unlink(secret.c_str()), 0);
  EXPECT_THROW(make_key(keys.directory, "a", false), ConfigError);  // a key is lost
  EXPECT_NE(access(secret.c_str(), F_OK), 0);
}

TEST(Keys, InARingCountAsFilesOfTheirOwn) {
  const Keys keys({"time-master", "a", "b"}, {"scorer"});
  make_rings(keys.directory, {{"sensors", {"a", "b"}}});
  const std::string rings = keys.directory + "/rings";
  for (const char* name : {"a", "b"}) {
    EXPECT_EQ(read_key(rings, name).secret_key, read_key(keys.directory, name).secret_key);
    EXPECT_EQ(public_key_of(rings, name), public_key_of(keys.directory, name));
  }
  EXPECT_THROW(read_key(rings, "time-master"), ConfigError);
  EXPECT_THROW(public_key_of(rings, "c"), ConfigError);
  const auto listed = read_allowed(keys.directory), in_ring = read_allowed(rings);
  ASSERT_EQ(in_ring.size(), 4u);
  for (const auto& [key, owner] : listed) {
    EXPECT_EQ(in_ring.at(key).name, owner.name);
    EXPECT_EQ(in_ring.at(key).truth, owner.name == "scorer");
  }
  EXPECT_THROW(make_rings(keys.directory, {{"sensors", {"a"}}}), ConfigError);  // none is replaced
  ASSERT_EQ(chmod((rings + "/sensors.keys").c_str(), 0640), 0);
  EXPECT_THROW(read_key(rings, "a"), ConfigError);
}

TEST(Keys, OfAnAgentSayForWhomItMaySpeak) {
  const Keys keys({"a", "b"}, {"scorer"});
  make_key(keys.directory, "host-1", false, {"a", "b"});
  make_rings(keys.directory, {{"host-1", {"host-1", "a", "b"}}});
  for (const std::string& directory : {keys.directory, keys.directory + "/rings"})
    for (const auto& [key, owner] : read_allowed(directory)) {
      const std::set<std::string> expected =
          owner.name == "host-1" ? std::set<std::string>{"a", "b"} : std::set<std::string>{};
      EXPECT_EQ(owner.nodes, expected) << directory << ": " << owner.name;
    }
  EXPECT_NO_THROW(read_key(keys.directory + "/rings", "host-1"));
  for (const char* nobody : {"time-master", "broker", operator_name, "two words", ""})
    EXPECT_THROW(make_key(keys.directory, "host-2", false, {nobody}), ConfigError) << nobody;
}

TEST(Keys, AreRequiredForAnythingButLoopback) {
  for (const char* address : {"tcp://127.0.0.1:0", "tcp://127.9.9.9:5", "ipc:///tmp/x",
                              "inproc://x", "tcp://[::1]:0", "tcp://localhost:1"})
    EXPECT_TRUE(is_loopback(address)) << address;
  for (const char* address : {"tcp://0.0.0.0:0", "tcp://*:0", "tcp://10.0.0.1:5",
                              "tcp://127.0.0.1.example.org:5", "tcp://eth0:5", "tcp://[::]:5", ""})
    EXPECT_FALSE(is_loopback(address)) << address;
  zmq::context_t context(1);
  auto socket = make_socket(context, zmq::socket_type::router, max_control_bytes);
  EXPECT_THROW(bind_to(socket, "tcp://0.0.0.0:0"), ConfigError);
  EXPECT_THROW(connect_to(socket, "tcp://192.0.2.1:5"), ConfigError);
}

TEST(Security, KnowsWhoSpeaks) {
  const Keys keys({"server", "a"});
  Server server(keys, Domain::control);
  Client client(server, Security(keys.directory, "a"));
  auto message = server.hears(patience);
  ASSERT_EQ(message.size(), 2u);
  EXPECT_EQ(sender_of(message[1]), "a");
  EXPECT_FALSE(may_receive_truth(message[1]));
}

TEST(Security, RefusesPlainClientsAndKeysThatAreNotOnTheList) {
  const Keys keys({"server", "a"}), others({"server", "a"});
  Server server(keys, Domain::control);
  Client plain(server, {});
  EXPECT_TRUE(server.hears(in_vain).empty());
  // Right about the server, but with a key of its own making.
  std::filesystem::copy_file(keys.directory + "/server.pub", others.directory + "/server.pub",
                             std::filesystem::copy_options::overwrite_existing);
  Client stranger(server, Security(others.directory, "a"));
  EXPECT_TRUE(server.hears(in_vain).empty());
}

TEST(Security, ServesTruthToThoseWhoMayHearIt) {
  const Keys keys({"server", "tracker"}, {"scorer"});
  Server server(keys, Domain::truth);
  Client tracker(server, Security(keys.directory, "tracker"));
  EXPECT_TRUE(server.hears(in_vain).empty());
  Client scorer(server, Security(keys.directory, "scorer"));
  auto message = server.hears(patience);
  ASSERT_EQ(message.size(), 2u);
  EXPECT_TRUE(may_receive_truth(message[1]));
}

TEST(Security, ListsAreReadAnewForEveryConnection) {
  const Keys keys({"server", "a"});
  Server server(keys, Domain::control);
  make_key(keys.directory, "late", false);
  Client late(server, Security(keys.directory, "late"));
  EXPECT_EQ(server.hears(patience).size(), 2u);
  const Security revoked(keys.directory, "a");
  std::filesystem::remove(keys.directory + "/a.pub");
  Client client(server, revoked);
  EXPECT_TRUE(server.hears(in_vain).empty());
}

TEST(Security, AKeyIsReplacedWithoutARestartOfTheServer) {
  const Keys keys({"server", "a"});
  Server server(keys, Domain::control);
  const Security before(keys.directory, "a");
  for (const char* ending : {"/a.key", "/a.pub"}) std::filesystem::remove(keys.directory + ending);
  make_key(keys.directory, "a", false);
  Client old(server, before);
  EXPECT_TRUE(server.hears(in_vain).empty());
  Client fresh(server, Security(keys.directory, "a"));
  auto message = server.hears(patience);
  ASSERT_EQ(message.size(), 2u);
  EXPECT_EQ(sender_of(message[1]), "a");
}

struct SecureNetwork {
  SecureNetwork()
      : keys({"time-master", "broker", "orbit", "a", operator_name}, {"recorder"}),
        master(with_keys(keys.directory)) {}
  static MasterOptions with_keys(const std::string& directory) {
    MasterOptions options = run_of({"orbit", "a", "recorder"}, 30, 3);
    options.keys = directory;
    return options;
  }
  std::future<NodeResult> start(Participant& participant) {
    return std::async(std::launch::async, [&participant, this] {
      return run_node(participant, {.master = master.address, .keys = keys.directory});
    });
  }
  Keys keys;
  MasterThread master;
};

TEST(Security, ARunWithKeysGivesTheBytesOfOneWithout) {
  SecureNetwork network;
  auto broker = std::async(std::launch::async, [&] {
    return run_broker({.master = network.master.address, .keys = network.keys.directory});
  });
  ToyOrbit orbit;
  ToyCamera camera("a");
  ToyRecorder recorder({"a"});  // hears truth as well
  auto a = network.start(orbit), b = network.start(camera), c = network.start(recorder);
  EXPECT_EQ(network.master.result.get().exit_code, 0);
  for (auto* node : {&a, &b, &c}) EXPECT_EQ(node->get().exit_code, 0);
  const BrokerResult passed = broker.get();
  EXPECT_GT(passed.messages, 0u);
  EXPECT_EQ(passed.refused, 0u);

  ToyOrbit orbit_here;
  ToyCamera camera_here("a");
  ToyRecorder recorder_here({"a"});
  drive({&orbit_here, &camera_here, &recorder_here}, 30);
  EXPECT_TRUE(recorder.record() == recorder_here.record());
}

TEST(Security, NobodyJoinsUnderAnothersName) {
  SecureNetwork network;
  // "a" holds its own key, and says to be orbit.
  const Security a(network.keys.directory, "a");
  zmq::context_t context(1);
  MasterLink link(context, network.master.address, nullptr, a);
  v1::Join join;
  join.set_name("orbit");
  EXPECT_THROW(link.join(join, std::chrono::milliseconds(500)), Error);
  EXPECT_TRUE(ask_master(network.master.address, 5, Security(network.keys.directory, operator_name))
                  .nodes.empty());
}

TEST(Security, TheBrokerPassesNothingInAnothersName) {
  SecureNetwork network;
  auto broker = std::async(std::launch::async, [&] {
    return run_broker({.master = network.master.address, .keys = network.keys.directory});
  });
  const Security asking(network.keys.directory, operator_name);
  BrokerEndpoints endpoints;
  while (endpoints.publish.empty())
    endpoints = ask_master(network.master.address, 5, asking).broker;

  const Security a(network.keys.directory, "a");
  zmq::context_t context(1);
  auto publisher = make_socket(context, zmq::socket_type::pub, max_data_bytes);
  connect_to(publisher, endpoints.publish, a, "broker");
  auto listener = make_socket(context, zmq::socket_type::sub, max_data_bytes);
  listener.set(zmq::sockopt::subscribe, "");
  connect_to(listener, endpoints.observe, a, "broker");
  const auto forged = std::make_shared<const Frames>(seal("state/objects", {.publisher = "orbit"}));
  const auto own = std::make_shared<const Frames>(seal("detection/a", {.publisher = "a"}));
  const auto deadline = now() + patience;
  std::vector<zmq::message_t> heard;
  while (heard.empty() && now() < deadline) {  // until the subscription has come through
    send(publisher, forged);
    send(publisher, own);
    std::vector<zmq::pollitem_t> items{{listener.handle(), 0, ZMQ_POLLIN, 0}};
    wait_for(items, std::chrono::milliseconds(20));
    heard = receive(listener);
  }
  int count = 0;
  for (; !heard.empty(); heard = receive(listener), ++count)
    EXPECT_EQ(heard[0].to_string(), "detection/a");
  EXPECT_GT(count, 0);
  network.master.stop.set();
  EXPECT_GT(broker.get().refused, 0u);
}

/// What comes on a socket within the time; empty if nothing does.
std::vector<zmq::message_t> heard_on(zmq::socket_t& socket, std::chrono::nanoseconds within) {
  std::vector<zmq::pollitem_t> items{{socket.handle(), 0, ZMQ_POLLIN, 0}};
  wait_for(items, within);
  return receive(socket);
}

TEST(Security, TruthIsAskedForAgainByThoseWhoMayHearIt) {
  SecureNetwork network;
  make_key(network.keys.directory, "tracker", false);
  auto broker = std::async(std::launch::async, [&] {
    return run_broker({.master = network.master.address, .keys = network.keys.directory});
  });
  // The run stands in tick 2, until all have been asked.
  std::promise<void> asked;
  std::shared_future<void> go_on = asked.get_future().share();
  ToyOrbit orbit;
  ToyCamera camera("a");
  std::promise<void> at_work;
  camera.on_step = [&](Tick tick) {
    if (tick == 2) at_work.set_value(), go_on.wait();
  };
  ToyRecorder recorder({"a"});
  auto a = network.start(orbit), b = network.start(camera), c = network.start(recorder);
  ASSERT_EQ(at_work.get_future().wait_for(patience), std::future_status::ready);

  zmq::context_t context(1);
  auto hello = make_socket(context, zmq::socket_type::dealer, max_control_bytes);
  connect_to(hello, network.master.address, Security(network.keys.directory, operator_name),
             master_name);
  v1::NodeMessage question;
  question.mutable_hello();
  hello.send(to_frame(question), zmq::send_flags::none);
  v1::MasterMessage answer;
  const auto told = heard_on(hello, patience);
  ASSERT_TRUE(told.size() == 1 && from_frame(told[0], &answer));
  std::string address;
  for (const auto& publisher : answer.endpoints().publishers())
    if (publisher.name() == "a") address = publisher.resend_endpoint();

  const auto answers = [&](const char* who, const char* topic, std::chrono::nanoseconds within) {
    auto asker = make_socket(context, zmq::socket_type::dealer, max_data_bytes);
    connect_to(asker, address, Security(network.keys.directory, who), "a");
    v1::ResendRequest request;
    request.set_run_id(answer.endpoints().run_id());
    request.set_topic(topic);
    asker.send(to_frame(request), zmq::send_flags::none);
    const auto message = heard_on(asker, within);
    return !message.empty() && message[0].to_string() == topic;
  };
  EXPECT_TRUE(answers("tracker", "detection/a", patience));
  EXPECT_FALSE(answers("tracker", "truth/a", in_vain));
  EXPECT_TRUE(answers("recorder", "truth/a", patience));
  asked.set_value();
  for (auto* node : {&a, &b, &c}) EXPECT_EQ(node->get().exit_code, 0);
  EXPECT_EQ(broker.get().exit_code, 0);
}

TEST(Security, NobodyBeatsForAnother) {
  SecureNetwork network;
  ToyOrbit orbit;
  auto waiting = network.start(orbit);  // for the others
  const Security asking(network.keys.directory, operator_name);
  const auto deadline = now() + patience;
  RunStatus status;
  while (status.nodes.empty() && now() < deadline)
    status = ask_master(network.master.address, 5, asking);
  ASSERT_EQ(status.nodes.size(), 1u);

  zmq::context_t context(1);
  const auto is_answered = [&](const char* who, std::chrono::nanoseconds within) {
    auto socket = make_socket(context, zmq::socket_type::dealer, max_control_bytes);
    connect_to(socket, network.master.address, Security(network.keys.directory, who), master_name);
    v1::NodeMessage message;
    message.set_run_id(status.run_id);
    message.mutable_heartbeat()->set_name("orbit");
    message.mutable_heartbeat()->set_incarnation(1);
    socket.send(to_frame(message), zmq::send_flags::none);
    return !heard_on(socket, within).empty();
  };
  EXPECT_FALSE(is_answered("a", in_vain));
  EXPECT_TRUE(is_answered("orbit", patience));
  network.master.stop.set();
  EXPECT_NE(waiting.get().exit_code, 0);
}

}  // namespace
}  // namespace dmise
