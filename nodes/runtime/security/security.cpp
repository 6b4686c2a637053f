#include "nodes/runtime/security/security.h"

#include <sodium.h>
#include <spdlog/spdlog.h>

#include <cstring>
#include <random>
#include <thread>
#include <vector>

#include "core/base/error.h"
#include "nodes/runtime/process/event.h"
#include "nodes/runtime/process/limited_log.h"

namespace dmise {
namespace {

constexpr const char* zap_endpoint = "inproc://zeromq.zap.01";
constexpr const char* truth_property = "X-Truth";
constexpr const char* nodes_property = "X-Nodes";  // names, a line end before and after each

const char* name_of(Domain domain) {
  if (domain == Domain::control) return "control";
  return domain == Domain::truth ? "truth" : "data";
}

/// One ZMTP property: length, name, length in four bytes, value.
std::string property(std::string_view name, std::string_view value) {
  std::string text(1, static_cast<char>(name.size()));
  text += name;
  for (int shift = 24; shift >= 0; shift -= 8) text += static_cast<char>(value.size() >> shift);
  return text += value;
}

std::string property_of(zmq::message_t& frame, const char* name) {
  const char* value = zmq_msg_gets(frame.handle(), name);
  return value ? value : "";
}

/// Grants of a key, as properties of its connection.
std::string properties_of(const AllowedKey& owner) {
  std::string properties;
  if (owner.truth) properties += property(truth_property, "1");
  std::string nodes = "\n";
  for (const auto& node : owner.nodes) nodes += node + "\n";
  if (!owner.nodes.empty()) properties += property(nodes_property, nodes);
  return properties;
}

/// Compares in a time that depends on lengths only.
bool is_same(std::string_view a, std::string_view b) {
  return a.size() == b.size() && sodium_memcmp(a.data(), b.data(), a.size()) == 0;
}

void set_client_password(zmq::socket_t& socket, const std::string& password) {
  if (password.empty()) {
    zmq_setsockopt(socket.handle(), ZMQ_PLAIN_USERNAME, nullptr, 0);  // back to no mechanism
    return;
  }
  socket.set(zmq::sockopt::plain_username, "node");
  socket.set(zmq::sockopt::plain_password, password);
}

}  // namespace

Security serving(Security security) {
  if (security.on()) return security;
  std::random_device random;
  std::string password;
  for (int i = 0; i < 4; ++i) password += fmt::format("{:08x}", random());
  security.set_password(password);
  return security;
}

Security::Security(std::string directory, const std::string& name, std::string via)
    : directory_(std::move(directory)), via_(std::move(via)) {
  if (!on()) return;
  key_ = read_key(directory_, name);
  check_keys(directory_);
}

void Security::require_for(const std::string& address) const {
  if (!on() && !is_loopback(address))
    throw ConfigError(
        address +
        ": not loopback, and there are no keys: dmise keygen makes them, --keys names "
        "their directory");
}

void Security::serve(zmq::socket_t& socket, const std::string& address, Domain domain) const {
  require_for(address);
  if (!on()) {
    if (domain != Domain::run || password_.empty()) return;
    socket.set(zmq::sockopt::plain_server, 1);
  } else {
    socket.set(zmq::sockopt::curve_server, 1);
    socket.set(zmq::sockopt::curve_secretkey, key_.secret_key);
  }
  socket.set(zmq::sockopt::zap_domain, name_of(domain));
}

void Security::call(zmq::socket_t& socket, const std::string& address,
                    const std::string& peer) const {
  require_for(address);
  if (!on()) {
    if (peer == broker_name) set_client_password(socket, password_);
    return;
  }
  const bool at_agent = !via_.empty() && (peer == master_name || peer == broker_name);
  socket.set(zmq::sockopt::curve_serverkey, public_key_of(directory_, at_agent ? via_ : peer));
  socket.set(zmq::sockopt::curve_publickey, key_.public_key);
  socket.set(zmq::sockopt::curve_secretkey, key_.secret_key);
}

struct ZapAuthenticator::Work {
  Work(zmq::context_t& context, const Security& security)
      : directory(security.directory()),
        password(security.password()),
        requests(context, zmq::socket_type::rep) {
    requests.set(zmq::sockopt::linger, 0);
    requests.bind(zap_endpoint);
    thread = std::thread([this] { run(); });
  }
  ~Work() {
    quit.set();
    thread.join();
  }

  void run() {
    while (!quit.is_set()) {
      std::vector<zmq::pollitem_t> items{{nullptr, quit.fd(), ZMQ_POLLIN, 0},
                                         {requests.handle(), 0, ZMQ_POLLIN, 0}};
      try {
        zmq::poll(items, std::chrono::milliseconds(1000));
      } catch (const zmq::error_t& error) {
        if (error.num() == EINTR) continue;
        return;
      }
      if (items[1].revents) answer();
      log.sum_up();
    }
  }

  /// Frames: version, request, domain, address, identity, mechanism, credentials.
  void answer() {
    std::vector<std::string> request;
    zmq::message_t frame;
    do {
      if (!requests.recv(frame, zmq::recv_flags::none)) return;
      request.push_back(frame.to_string());
    } while (frame.more());
    if (directory.empty()) return answer_plain(request);
    const bool whole = request.size() == 7 && request[5] == "CURVE" && request[6].size() == 32;
    char key[41] = "";
    if (whole) zmq_z85_encode(key, reinterpret_cast<const std::uint8_t*>(request[6].data()), 32);
    std::vector<std::string> left_out;
    const auto allowed = read_allowed(directory, &left_out);
    for (const std::string& fault : left_out) log.warn("key files left out", fault);
    const auto who = allowed.find(key);
    const bool welcome =
        whole && who != allowed.end() && (request[2] != "truth" || who->second.truth);
    if (!welcome)
      log.warn(
          "connections refused",
          fmt::format(
              "refused a connection to {} from {}: {}", request.size() > 2 ? request[2] : "nothing",
              request.size() > 3 ? request[3] : "nowhere",
              who == allowed.end() ? "no such key is allowed" : who->second.name + " may not"));
    reply(request, welcome, welcome ? who->second.name : "",
          welcome ? properties_of(who->second) : "");
  }

  /// Answers a request with two credentials: user name and password.
  void answer_plain(const std::vector<std::string>& request) {
    const bool welcome =
        request.size() == 8 && request[5] == "PLAIN" && is_same(request[7], password);
    if (!welcome)
      log.warn("connections refused",
               fmt::format("refused a connection from {}: only nodes of the run may publish and "
                           "subscribe there",
                           request.size() > 3 ? request[3] : "nowhere"));
    reply(request, welcome, "", "");
  }

  void reply(const std::vector<std::string>& request, bool welcome, const std::string& name,
             const std::string& properties) {
    for (const std::string& part :
         {std::string("1.0"), request.size() > 1 ? request[1] : std::string(),
          std::string(welcome ? "200" : "400"), std::string(welcome ? "OK" : "not allowed"), name})
      requests.send(zmq::buffer(part), zmq::send_flags::sndmore);
    requests.send(zmq::buffer(properties), zmq::send_flags::none);
  }

  std::string directory, password;
  zmq::socket_t requests;
  Event quit;
  LimitedLog log;
  std::thread thread;
};

ZapAuthenticator::ZapAuthenticator(zmq::context_t& context, const Security& security)
    : work_(security.on() || !security.password().empty()
                ? std::make_unique<Work>(context, security)
                : nullptr) {}

ZapAuthenticator::~ZapAuthenticator() = default;

std::string sender_of(zmq::message_t& frame) { return property_of(frame, "User-Id"); }

bool may_receive_truth(zmq::message_t& frame) { return property_of(frame, truth_property) == "1"; }

bool is_agent_key(zmq::message_t& frame) {
  return zmq_msg_gets(frame.handle(), nodes_property) != nullptr;
}

bool may_speak_for(zmq::message_t& frame, const std::string& node) {
  const char* nodes = zmq_msg_gets(frame.handle(), nodes_property);
  return nodes && node.find('\n') == std::string::npos &&
         std::string_view(nodes).find("\n" + node + "\n") != std::string_view::npos;
}

}  // namespace dmise
