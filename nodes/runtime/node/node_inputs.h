#pragma once
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "dmise/v1/time.pb.h"
#include "nodes/runtime/observability/figures.h"
#include "nodes/runtime/protocol/inbox.h"
#include "nodes/runtime/transport/broker_place.h"
#include "nodes/runtime/transport/socket.h"

namespace dmise {

/// All that a node hears from other nodes: what is published through the broker or on a publisher's
/// own socket, and what it has asked for again. Used from one thread.
class NodeInputs {
 public:
  NodeInputs(zmq::context_t& context, std::vector<std::string> topics, const Security& security);

  void start(const RunFacts& run) { run_ = run, receiver_.emplace(run); }
  /// Connects to everybody; again when somebody has taken the place of another.
  void connect(const v1::Topology& topology);
  /// See Inbox; to catch up is to ask every publisher for what it keeps.
  void begin_at(Tick tick, bool catch_up);
  /// What the clock says of topics.
  void hear(const std::vector<v1::ClosedTopic>& closed, const std::vector<v1::TopicTally>& said);

  /// Takes in all that has arrived.
  void receive();
  /// Asks again for what keeps `tick` from being complete, if it is time to. Returns how long to
  /// wait for an answer at most.
  std::chrono::nanoseconds ask_for(Tick tick);
  /// The next wait is for another tick.
  void be_patient_again();

  bool probed() const { return inbox_.probed(); }
  bool complete(Tick tick) const { return inbox_.complete(tick); }
  std::vector<Message> take(Tick tick) { return inbox_.take(tick); }
  /// Whether a question asks for all from a tick on, whatever is lost before: that of who holds
  /// nobody's time.
  void set_may_miss(bool may_miss) { may_miss_ = may_miss; }
  /// A seam for tests: every n-th message that is published, once the run has begun, is lost; 0:
  /// none.
  void lose_every(int n) { lose_every_ = n; }

  const std::vector<zmq::socket_t*>& sockets() const { return sockets_; }
  std::uint64_t refused() const { return receiver_ ? receiver_->refused() : 0; }
  /// What can be said of inputs.
  NodeFigures figures() const;
  std::string last_refusal() const { return receiver_ ? receiver_->last_refusal() : ""; }
  std::uint64_t asked_again() const { return asked_again_; }
  std::uint64_t asked_for_known() const { return asked_for_known_; }
  std::uint64_t lost() const { return lost_; }
  std::uint64_t missed() const { return inbox_.missed(); }
  void close();

  /// Whether the topic is one of its own list.
  bool consumes(const std::string& topic) const;

 private:
  struct Source {  // a publisher of consumed topics
    std::uint64_t incarnation = 0;
    std::string resend_endpoint;
    std::vector<std::string> topics;
    std::optional<zmq::socket_t> direct;  // SUB to its own socket
    std::optional<zmq::socket_t> asker;   // DEALER to its resend endpoint
  };
  void follow(const v1::Publisher& publisher);
  void receive_from(zmq::socket_t& socket, const std::string* publisher, Inbox::Way way);
  void learn_patience();
  void say_forged();
  void ask(const std::string& topic, std::uint64_t from_sequence, std::optional<Tick> from_tick);
  void list_sockets();

  zmq::context_t& context_;
  Security security_;
  std::vector<std::string> topics_;
  RunFacts run_;
  std::optional<Receiver> receiver_;
  Inbox inbox_;
  zmq::socket_t subscribe_;
  BrokerPlace broker_;
  std::map<std::string, Source> sources_;            // by name of the publisher
  std::map<std::string, std::string> publisher_of_;  // each consumed topic
  std::vector<zmq::socket_t*> sockets_;              // that data arrive on
  bool may_miss_ = false;
  std::chrono::nanoseconds asked_{0};
  enum class Missing { nothing, quiet, gap } missing_ = Missing::nothing;  // of the tick awaited
  std::chrono::nanoseconds quiet_{0};
  std::chrono::nanoseconds gap_{0};
  std::chrono::nanoseconds again_{0};  // least patience once it was asked for at this tick
  std::optional<std::uint64_t> duplicates_when_asked_;  // for a gap; nothing came twice since
  std::uint64_t asked_again_ = 0;
  std::uint64_t asked_for_known_ = 0;
  int lose_every_ = 0;
  std::uint64_t countdown_ = 0, lost_ = 0;  // of that seam
  std::uint64_t received_ = 0;
  std::uint64_t forged_said_ = 0;
};

}  // namespace dmise
