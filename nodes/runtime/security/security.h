#pragma once
#include <memory>
#include <string>
#include <zmq.hpp>

#include "nodes/runtime/security/keys.h"

namespace dmise {

// Names of keys other than those of nodes.
inline constexpr const char* master_name = "time-master";
inline constexpr const char* broker_name = "broker";
inline constexpr const char* operator_name = "operator";  // may control the clock

/// Credentials of one process: CURVE (ZeroMQ RFC 26) with an allow-list (ZAP, RFC 27). Without keys
/// there is no encryption, and only loopback may be used.
class Security {
 public:
  Security() = default;
  /// `directory`: of keys made by `dmise keygen`; empty: no encryption. `name`: whose key this
  /// process holds. `via`: the agent that acts as time-master and broker for this process, if any.
  /// Throws `ConfigError`.
  Security(std::string directory, const std::string& name, std::string via = "");

  bool on() const { return !directory_.empty(); }

  /// Configures a socket that others connect to. Throws `ConfigError` for an address that is not
  /// loopback if there are no keys.
  void serve(zmq::socket_t& socket, const std::string& address, Domain domain) const;
  /// Configures a socket that connects to the process `peer`. Throws `ConfigError` also if the
  /// peer's key is unknown.
  void call(zmq::socket_t& socket, const std::string& address, const std::string& peer) const;

  const std::string& directory() const { return directory_; }

  /// Without keys: password required at `Domain::run`, and sent to the broker. Empty: none.
  void set_password(std::string password) { password_ = std::move(password); }
  const std::string& password() const { return password_; }

 private:
  void require_for(const std::string& address) const;

  std::string directory_, via_, password_;
  KeyPair key_;
};

/// A copy for a process that serves a run, with a new password if there are no keys.
Security serving(Security security);

/// Authenticates the connections of one context, rereading the list each time: an added, replaced
/// or removed file applies from the next connection on. Must outlive the serving sockets.
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

/// The authenticated name of a message's sender, "" without keys.
std::string sender_of(zmq::message_t& frame);
/// Whether its key may receive truth.
bool may_receive_truth(zmq::message_t& frame);
/// Whether its key is that of an agent.
bool is_agent_key(zmq::message_t& frame);
/// Whether its key is that of an agent which may speak for `node`.
bool may_speak_for(zmq::message_t& frame, const std::string& node);

}  // namespace dmise
