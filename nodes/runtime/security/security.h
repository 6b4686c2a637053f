#pragma once
#include <memory>
#include <string>
#include <zmq.hpp>

#include "nodes/runtime/security/keys.h"

namespace dmise {

// Names of keys beside those of nodes.
inline constexpr const char* master_name = "time-master";
inline constexpr const char* broker_name = "broker";
inline constexpr const char* operator_name = "operator";  // may ask the clock to do something

/// What one process needs to prove who it is and to know others: CURVE (ZeroMQ RFC 26) with an
/// allow-list (ZAP, RFC 27). Without keys everything is plain, and nothing but loopback may be
/// used.
class Security {
 public:
  Security() = default;
  /// `directory`: of keys as `dmise keygen` makes them; empty: plain. `name`: whose key this
  /// process holds. `via`: the agent that is time-master and broker to this process, if one is.
  /// Throws `ConfigError`.
  Security(std::string directory, const std::string& name, std::string via = "");

  bool on() const { return !directory_.empty(); }

  /// A socket that others connect to. Throws `ConfigError` for an address that is not loopback when
  /// there are no keys.
  void serve(zmq::socket_t& socket, const std::string& address, Domain domain) const;
  /// A socket that connects to the process `peer`. Throws `ConfigError` as well when it is not
  /// known.
  void call(zmq::socket_t& socket, const std::string& address, const std::string& peer) const;

  const std::string& directory() const { return directory_; }

  /// Without keys: what is asked at `Domain::run`, or said to the broker. Empty: nothing.
  void set_password(std::string password) { password_ = std::move(password); }
  const std::string& password() const { return password_; }

 private:
  void require_for(const std::string& address) const;

  std::string directory_, via_, password_;
  KeyPair key_;
};

/// A copy for who serves a run: without keys it has a new password.
Security serving(Security security);

/// Answers for one context who may connect, reading the list anew each time: a file that is added,
/// replaced or removed counts from the next connection on. Outlives the sockets that serve.
class ZapAuthenticator {
 public:
  ZapAuthenticator(zmq::context_t& context, const Security& security);
  ~ZapAuthenticator();
  ZapAuthenticator(const ZapAuthenticator&) = delete;
  ZapAuthenticator& operator=(const ZapAuthenticator&) = delete;

 private:
  struct Work;
  std::unique_ptr<Work> work_;  // null when there are neither keys nor a password
};

/// The name that the sender of a message has proved, "" without keys.
std::string sender_of(zmq::message_t& frame);
/// Whether its key may hear truth.
bool may_hear_truth(zmq::message_t& frame);
/// Whether its key is that of an agent, which may speak for some nodes.
bool is_agents(zmq::message_t& frame);
/// Whether its key is that of an agent which may speak for `node`.
bool may_speak_for(zmq::message_t& frame, const std::string& node);

}  // namespace dmise
