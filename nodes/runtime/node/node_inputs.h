#pragma once
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "dmise/v1/time.pb.h"
#include "nodes/runtime/observability/figures.h"
#include "nodes/runtime/protocol/inbox.h"
#include "nodes/runtime/transport/broker_connection.h"
#include "nodes/runtime/transport/socket.h"

namespace dmise {

/// Inputs of a node from other nodes: published through the broker or on a publisher's own socket,
/// and requested again. Used from one thread.
class NodeInputs {
 public:
  NodeInputs(zmq::context_t& context, std::vector<std::string> topics, const Security& security);

  void start(const RunFacts& run) { run_ = run, receiver_.emplace(run); }
  /// Connects to all publishers; again after a process was replaced.
  void connect(const v1::Topology& topology);
  /// See Inbox. Call before `begin_at`.
  void set_delay(const std::string& topic, Tick delay, Tick reaches_back) {
    inbox_.set_delay(topic, delay, reaches_back);
  }
  /// See Inbox; to catch up, all kept messages are requested from every publisher.
  void begin_at(Tick tick, Tick resumes_at, bool catch_up);
  /// Updates the state of topics from the clock's messages.
  void update_topics(const std::vector<v1::ClosedTopic>& closed,
                     const std::vector<v1::TopicTally>& published);

  /// Handles all messages that have arrived.
  void receive();
  /// Requests messages that keep `tick` from being complete, if it is time to. Returns the longest
  /// time to wait for an answer.
  std::chrono::nanoseconds ask_for(Tick tick);
  /// Starts to wait for the next tick.
  void reset_patience();

  bool probed() const { return inbox_.probed(); }
  bool complete(Tick tick) const { return inbox_.complete(tick); }
  std::vector<Message> take(Tick tick) { return inbox_.take(tick); }
  /// Whether requests ask for everything from a tick on, whatever is lost before: for nodes that
  /// the clock does not wait for.
  void set_may_miss(bool may_miss) { may_miss_ = may_miss; }
  /// For tests: drops every n-th published message once the run has begun; 0: none.
  void lose_every(int n) { lose_every_ = n; }

  const std::vector<zmq::socket_t*>& sockets() const { return sockets_; }
  std::uint64_t refused() const { return receiver_ ? receiver_->refused() : 0; }
  /// Counters of inputs.
  NodeFigures figures() const;
  std::string last_refusal() const { return receiver_ ? receiver_->last_refusal() : ""; }
  std::uint64_t resend_requests() const { return asked_again_; }
  std::uint64_t resend_requests_known() const { return asked_for_known_; }
  std::uint64_t lost() const { return lost_; }
  std::uint64_t missed() const { return inbox_.missed(); }
  void close();

  /// Whether the topic is one of the consumed topics.
  bool consumes(const std::string& topic) const;

 private:
  struct Source {  // a publisher of consumed topics
    std::uint64_t incarnation = 0;
    std::string resend_endpoint;
    std::optional<zmq::socket_t> direct;  // SUB, to its own socket
    std::optional<zmq::socket_t> asker;   // DEALER, to its resend endpoint
  };
  void follow(const v1::Publisher& publisher);
  void receive_from(zmq::socket_t& socket, const std::string* publisher, Inbox::Way way);
  void adapt_patience();
  void log_forged();
  void ask(const std::string& topic, std::uint64_t from_sequence, std::optional<Tick> from_tick);
  void list_sockets();

  zmq::context_t& context_;
  Security security_;
  std::vector<std::string> topics_;
  RunFacts run_;
  std::optional<Receiver> receiver_;
  Inbox inbox_;
  zmq::socket_t subscribe_;
  BrokerConnection broker_;
  std::map<std::string, Source> sources_;            // by name of the publisher
  std::map<std::string, std::string> publisher_of_;  // each consumed topic
  std::vector<zmq::socket_t*> sockets_;              // all receiving sockets
  bool may_miss_ = false;
  std::chrono::nanoseconds asked_{0};
  enum class Missing { nothing, quiet, gap } missing_ = Missing::nothing;  // at the awaited tick
  std::chrono::nanoseconds quiet_{0};
  std::chrono::nanoseconds gap_{0};
  std::chrono::nanoseconds again_{0};  // least patience after a request at this tick
  // At a request for a gap, if there were no duplicates since.
  std::optional<std::uint64_t> duplicates_when_asked_;
  std::uint64_t asked_again_ = 0;
  std::uint64_t asked_for_known_ = 0;
  int lose_every_ = 0;
  std::uint64_t countdown_ = 0, lost_ = 0;  // counted for `lose_every_`, and lost by it
  std::uint64_t received_ = 0;
  std::uint64_t forged_said_ = 0;
};

}  // namespace dmise
