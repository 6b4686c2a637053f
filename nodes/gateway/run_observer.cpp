#include "nodes/gateway/run_observer.h"

#include <spdlog/spdlog.h>

#include <map>

#include "core/base/error.h"
#include "core/base/formatted.h"
#include "nodes/gateway/live_view.h"
#include "nodes/runtime/observability/status.h"
#include "nodes/runtime/process/limited_log.h"
#include "nodes/runtime/process/monotonic_clock.h"
#include "nodes/runtime/protocol/control_rules.h"
#include "nodes/runtime/transport/broker_connection.h"
#include "nodes/runtime/transport/socket.h"
#include "nodes/wire/receiver.h"

namespace dmise {
namespace {

using std::chrono::milliseconds;

constexpr milliseconds publish_interval{100}, hello_interval{500}, silence{2000};
constexpr milliseconds roster_interval{2000};
constexpr milliseconds receive_at_most{50};  // before viewers are told
constexpr int unread_messages = 64;  // at the broker's socket; further ones wait there, then drop
constexpr std::size_t max_commands = 16;

// Topics that every viewer may see; truth has endpoints of its own.
constexpr const char* topics[] = {objects_topic,    environment_topic, frame_prefix,
                                  detection_prefix, track_prefix,      task_prefix};

static_assert(int(ClockCommand::Action::pause) == v1::Control::ACTION_PAUSE &&
              int(ClockCommand::Action::pace) == v1::Control::ACTION_PACE);

using RawMessage = std::vector<zmq::message_t>;

}  // namespace

/// Sockets of an observer. A time-master that was started again has another run.
class RunObserver::Connections {
 public:
  Connections(const RunObserverOptions& options, LatestMessages& latest, ViewHistory& history)
      : options_(options),
        security_(options.keys, options.name),
        subscription_(make_socket(context_, zmq::socket_type::sub, max_data_bytes)),
        broker_(subscription_),
        view_(latest, history, options.takes_truth) {
    subscription_.set(zmq::sockopt::rcvhwm, unread_messages);
    for (const char* topic : topics) subscription_.set(zmq::sockopt::subscribe, topic);
    if (options.takes_truth) {
      truth_.emplace(make_socket(context_, zmq::socket_type::sub, max_data_bytes));
      truth_->set(zmq::sockopt::rcvhwm, unread_messages);
      truth_->set(zmq::sockopt::subscribe, truth_prefix);
    }
    call_master();
  }

  void wait(const Event& stop, const Event& commands, Instant until) {
    std::vector<zmq::pollitem_t> items{{subscription_.handle(), 0, ZMQ_POLLIN, 0},
                                       {master_->handle(), 0, ZMQ_POLLIN, 0},
                                       {nullptr, stop.fd(), ZMQ_POLLIN, 0},
                                       {nullptr, commands.fd(), ZMQ_POLLIN, 0}};
    if (roster_) items.push_back({roster_->handle(), 0, ZMQ_POLLIN, 0});
    if (control_) items.push_back({control_->handle(), 0, ZMQ_POLLIN, 0});
    if (truth_) items.push_back({truth_->handle(), 0, ZMQ_POLLIN, 0});
    wait_for(items, std::max(Instant{0}, until - now()));
  }

  void receive() {
    hear_master(*master_);
    if (control_) hear_master(*control_);
    if (roster_)
      for (auto message = dmise::receive(*roster_); !message.empty();
           message = dmise::receive(*roster_))
        take(message);
    const Instant until = now() + receive_at_most;
    while (now() < until) {
      RawMessage message = dmise::receive(subscription_);
      if (message.empty()) break;
      heard(std::move(message));
    }
    while (truth_ && now() < until) {
      const RawMessage message = dmise::receive(*truth_);
      if (message.empty()) break;
      take(message);
    }
  }

  /// Asks the master for the state of the run, and the orbit node for the roster.
  void ask() {
    if (now() - asked_ < hello_interval) return;
    if (now() - answered_ > silence && asked_ > answered_) {
      if (log_.admits("questions")) spdlog::info("the time-master does not answer");
      options_.frames_served_at(run_.run_id, {});
      call_master();
      answered_ = now();
    }
    asked_ = now();
    v1::NodeMessage question;
    question.mutable_hello();
    master_->send(to_frame(question), zmq::send_flags::dontwait);
    ask_for_roster();
  }

  void control(const ClockCommand& command) {
    if (!receiver_) return view_.notify("the run does not answer yet");
    if (!control_) {
      control_.emplace(make_socket(context_, zmq::socket_type::dealer, max_control_bytes));
      connect_to(*control_, options_.master, Security(options_.keys, operator_name), master_name);
    }
    v1::NodeMessage question;
    question.set_run_id(run_.run_id);
    auto& control = *question.mutable_control();
    control.set_action(static_cast<v1::Control::Action>(command.action));
    if (command.action == ClockCommand::Action::step) control.set_tick(command.ticks);
    control.set_factor(command.factor);
    control_->send(to_frame(question), zmq::send_flags::dontwait);
  }

  void publish() {
    if (!objects_.empty()) {
      take(objects_);
      objects_.clear();
    }
    view_.publish();
    log_.sum_up();
  }

  LiveView& view() { return view_; }
  bool was_answered() const { return bool(receiver_); }

 private:
  void call_master() {
    master_.emplace(make_socket(context_, zmq::socket_type::dealer, max_control_bytes));
    connect_to(*master_, options_.master, security_, master_name);
  }

  void hear_master(zmq::socket_t& socket) {
    while (const auto frame = receive_one(socket)) {
      v1::MasterMessage message;
      if (!from_frame(*frame, &message) || !message.has_endpoints() || fault_of(message)) continue;
      answered_ = now();
      follow(message.endpoints());
    }
  }

  void follow(const v1::Endpoints& endpoints) {
    const RunStatus status = status_of(endpoints);
    const RunFacts run{status.run_id, status.tick_length, status.last_tick};
    if (!receiver_ || !(run == run_)) {
      run_ = run;
      receiver_.emplace(run);
      gaps_.clear();
      sequences_.clear();
    }
    for (const auto& publisher : endpoints.publishers())
      for (const auto& topic : publisher.topics()) {
        receiver_->allow(topic, publisher.name(), publisher.incarnation());
        publisher_of_[topic] = publisher.name();
        if (topic == objects_topic) orbit_ = publisher;
      }
    if (truth_)
      for (const auto& publisher : endpoints.publishers()) follow_truth(publisher);
    std::uint64_t incarnation = 0;  // the broker's; a recording that is replayed has none
    for (const auto& node : status.nodes)
      if (node.name == broker_name) incarnation = node.incarnation;
    if (!endpoints.observe_endpoint().empty())
      broker_.follow(endpoints.observe_endpoint(), incarnation, security_);
    tell_frame_endpoints(endpoints, status);
    view_.take(status, gaps_);
  }

  /// Each sensor publishes its truth itself.
  void follow_truth(const v1::Publisher& publisher) {
    if (publisher.direct_endpoint().empty()) return;
    for (const auto& topic : publisher.direct_topics())
      if (topic.starts_with(truth_prefix))
        receiver_->allow(topic, publisher.name(), publisher.incarnation());
    std::string& endpoint = truth_endpoints_[publisher.name()];
    if (endpoint == publisher.direct_endpoint()) return;
    if (!endpoint.empty()) truth_->disconnect(endpoint);
    endpoint = publisher.direct_endpoint();
    try {
      connect_to(*truth_, endpoint, security_, publisher.name());
    } catch (const Error& error) {
      view_.notify(std::string("no truth: ") + error.what());
    }
  }

  void tell_frame_endpoints(const v1::Endpoints& endpoints, const RunStatus& status) const {
    std::map<std::string, std::string> by_sensor;
    if (status.phase == Phase::running)
      for (const auto& publisher : endpoints.publishers())
        if (!publisher.frames_endpoint().empty())
          by_sensor[publisher.name()] = publisher.frames_endpoint();
    options_.frames_served_at(status.run_id, std::move(by_sensor));
  }

  /// Takes a message of the broker. Only the newest states of objects are decoded, when
  /// viewers are told.
  void heard(RawMessage message) {
    if (!receiver_ || message.size() < 3) return;
    v1::Envelope envelope;
    if (!envelope.ParseFromArray(message[1].data(), int(message[1].size()))) return;
    const std::string topic = message[0].to_string();
    count_gap(topic, envelope);
    if (topic == objects_topic && envelope.kind() == v1::KIND_OBJECT_STATES)
      objects_ = std::move(message);
    else
      take(message);
  }

  void count_gap(const std::string& topic, const v1::Envelope& envelope) {
    const auto publisher = publisher_of_.find(topic);
    if (publisher == publisher_of_.end() || envelope.sequence() == 0) return;
    auto& [incarnation, last] = sequences_[topic];
    if (incarnation == envelope.incarnation() && envelope.sequence() > last + 1)
      gaps_[publisher->second] += envelope.sequence() - last - 1;
    incarnation = envelope.incarnation();
    last = envelope.sequence();
  }

  void take(const RawMessage& message) {
    if (!receiver_) return;
    const auto frames = views(message);
    const auto received = receiver_->receive(frames);
    if (!received) {
      if (log_.admits("refused messages"))
        spdlog::debug("refused a message: {}", receiver_->last_refusal());
    } else if (received->state && received->envelope.run_id == run_.run_id) {
      view_.take(*received->state);
    }
  }

  /// The roster is published once: a late observer requests it from its publisher.
  void ask_for_roster() {
    if (view_.has_roster()) {
      roster_.reset();
      return;
    }
    if (!orbit_ || orbit_->resend_endpoint().empty() || now() - roster_asked_ < roster_interval)
      return;
    roster_asked_ = now();
    try {
      roster_.emplace(make_socket(context_, zmq::socket_type::dealer, max_data_bytes));
      connect_to(*roster_, orbit_->resend_endpoint(), security_, orbit_->name());
    } catch (const Error& error) {
      roster_.reset();
      if (log_.admits("rosters")) spdlog::info("objects have no names: {}", error.what());
      return;
    }
    v1::ResendRequest request;
    request.set_run_id(run_.run_id);
    request.set_topic(objects_topic);
    request.set_catch_up(true);
    request.set_from_tick(run_.last_tick);
    roster_->send(to_frame(request), zmq::send_flags::dontwait);
  }

  const RunObserverOptions& options_;
  Security security_;
  zmq::context_t context_{1};
  zmq::socket_t subscription_;
  BrokerConnection broker_;
  std::optional<zmq::socket_t> master_, control_, roster_, truth_;
  std::map<std::string, std::string> truth_endpoints_;  // by sensor
  LiveView view_;
  LimitedLog log_;
  RunFacts run_;
  std::optional<Receiver> receiver_;
  std::map<std::string, std::string> publisher_of_;  // by topic
  std::optional<v1::Publisher> orbit_;
  std::map<std::string, std::pair<std::uint64_t, std::uint64_t>> sequences_;  // by topic
  std::map<std::string, std::uint64_t> gaps_;                                 // by publisher
  RawMessage objects_;
  Instant asked_{0}, answered_{0}, roster_asked_{0};
};

void RunObserver::run(const std::function<void()>& changed) {
  Connections connections(options_, latest_, history_);
  Instant next = now() + publish_interval;
  const Instant begun = now();
  const auto within = std::chrono::duration<double>(options_.answer_within_s);
  while (!options_.stop->is_set()) {
    if (within.count() > 0.0 && !connections.was_answered() && now() - begun > within)
      throw Error(options_.master + ": no time-master answers within " +
                  shortest_text(options_.answer_within_s) + " s");
    connections.wait(*options_.stop, has_commands_, next);
    try {
      for (const ClockCommand& command : take_commands()) connections.control(command);
      connections.receive();
      connections.ask();
      if (now() < next) continue;
      next = now() + publish_interval;
      connections.publish();
      changed();
    } catch (const ConfigError& error) {  // the operator's key is at fault
      connections.view().notify(error.what());
    } catch (const Error& error) {
      spdlog::warn("{}", error.what());
    }
  }
}

bool RunObserver::command(const ClockCommand& command) {
  const std::lock_guard lock(mutex_);
  if (commands_.size() >= max_commands) return false;
  commands_.push_back(command);
  has_commands_.set();
  return true;
}

std::vector<ClockCommand> RunObserver::take_commands() {
  const std::lock_guard lock(mutex_);
  has_commands_.clear();
  return std::exchange(commands_, {});
}

}  // namespace dmise
