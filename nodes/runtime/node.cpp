#include "nodes/runtime/node.h"

#include <spdlog/spdlog.h>

#include <algorithm>
#include <map>

#include "core/base/error.h"
#include "nodes/runtime/inbox.h"
#include "nodes/runtime/master_link.h"

namespace dmise {
namespace {

using std::chrono::duration;
using std::chrono::duration_cast;
using std::chrono::milliseconds;
using std::chrono::nanoseconds;

constexpr milliseconds probe_interval{10};
constexpr milliseconds gap_patience{20};     // a later message is here: this one is late or lost
constexpr milliseconds quiet_patience{500};  // nothing is here: the producer may be slow
constexpr milliseconds quiet_patience_limit{8000};  // doubled each time up to this
constexpr milliseconds idle{1000};

bool is_direct(const std::string& topic) { return topic.starts_with(truth_prefix); }

/// Adds the time of its life to one part of the split.
class Stopwatch {
 public:
  explicit Stopwatch(double* total_s) : total_s_(total_s), start_(now()) {}
  ~Stopwatch() { *total_s_ += duration<double>(now() - start_).count(); }

 private:
  double* total_s_;
  nanoseconds start_;
};

class Node {
 public:
  Node(Participant& participant, const NodeOptions& options)
      : participant_(participant),
        options_(options),
        produces_(participant.produces()),
        consumes_(participant.consumes()),
        link_(control_context_, options.master, options.stop),
        publish_(make_socket(data_context_, zmq::socket_type::pub, max_data_bytes)),
        direct_(make_socket(data_context_, zmq::socket_type::pub, max_data_bytes)),
        subscribe_(make_socket(data_context_, zmq::socket_type::sub, max_data_bytes)),
        inbox_(consumes_) {
    publish_.set(zmq::sockopt::linger, 1000);
    direct_.set(zmq::sockopt::linger, 1000);
  }

  void run(NodeResult* result) {
    result_ = result;
    join();
    try {
      if (gather()) work();
    } catch (const std::exception& error) {
      link_.set_computing(false);
      link_.failed(error.what());
      throw;
    }
    finish();
  }

 private:
  void join() {
    v1::Join request;
    request.set_name(participant_.name());
    for (const std::string& topic : produces_)
      *(is_direct(topic) ? request.add_produces_direct() : request.add_produces()) = topic;
    for (const std::string& topic : consumes_) request.add_consumes(topic);
    if (request.produces_direct_size() > 0)
      request.set_direct_endpoint(bind_to(direct_, options_.host));
    std::optional<zmq::socket_t> resend;
    if (!produces_.empty()) {
      resend = make_socket(control_context_, zmq::socket_type::router, max_control_bytes);
      request.set_resend_endpoint(bind_to(*resend, options_.host));
    }

    const auto within = duration_cast<nanoseconds>(duration<double>(options_.join_within_s));
    const v1::Welcome welcome = link_.join(request, within);
    run_ = {welcome.run_id(), {welcome.tick_ns()}, welcome.last_tick()};
    receiver_.emplace(run_);
    outbox_.emplace(run_, participant_.name(), welcome.incarnation(), produces_,
                    Tick(welcome.window_ticks()) + 1);
    KeeperOptions keeper;
    keeper.stop_within = duration_cast<nanoseconds>(duration<double>(options_.stop_within_s));
    keeper.progress = [this] { return participant_.progress(); };
    keeper.resend = [this](const std::string& topic, std::uint64_t from) {
      return outbox_->since(topic, from);
    };
    link_.keep(std::move(keeper), std::move(resend));
    spdlog::debug("joined {}", options_.master);
  }

  /// Connects to everybody and waits for the first grant. False when the run is over before.
  bool gather() {
    while (!link_.topology() && going()) link_.wait({}, idle);
    if (!going()) return false;
    connect_data();
    const auto probes = outbox_->probes();
    bool said_ready = false;
    while (link_.granted() < 0 && going()) {
      for (const SharedFrames& probe : probes) publish(probe);
      link_.wait(sockets_, probe_interval);
      receive_data();
      if (!said_ready && inbox_.probed() && link_.hears_ticks()) {
        link_.ready();
        said_ready = true;
      }
    }
    return going();
  }

  void connect_data() {
    const v1::Topology& topology = *link_.topology();
    const auto consumed = [&](const std::string& topic) {
      return std::find(consumes_.begin(), consumes_.end(), topic) != consumes_.end();
    };
    bool through_broker = false;
    for (const auto& publisher : topology.publishers()) {
      bool direct = false, any = false;
      const auto allow = [&](const std::string& topic) {
        receiver_->allow(topic, publisher.name(), publisher.incarnation());
        resend_of_[topic] = publisher.resend_endpoint();
        any = true;
      };
      for (const std::string& topic : publisher.topics())
        if (consumed(topic)) allow(topic), through_broker = true;
      for (const std::string& topic : publisher.direct_topics())
        if (consumed(topic)) allow(topic), direct = true;
      if (direct) connect_to(subscribe_, publisher.direct_endpoint());
    }
    for (const std::string& topic : consumes_) subscribe_.set(zmq::sockopt::subscribe, topic);
    if (through_broker) connect_to(subscribe_, topology.subscribe_endpoint());
    if (!consumes_.empty()) sockets_.push_back(&subscribe_);
    if (std::any_of(produces_.begin(), produces_.end(),
                    [](const std::string& topic) { return !is_direct(topic); }))
      connect_to(publish_, topology.publish_endpoint());
  }

  void work() {
    for (Tick tick = 0; tick <= run_.last_tick; ++tick) {
      if (!await(tick)) return;
      const std::vector<Message> inputs = inbox_.take(tick);
      std::vector<Message> outputs;
      {
        const Stopwatch watch(&result_->times.compute_s);
        link_.set_computing(true);
        outputs = participant_.step(tick, inputs);
        link_.set_computing(false);
      }
      const Stopwatch watch(&result_->times.messaging_s);
      for (const SharedFrames& frames : outbox_->pack(tick, outputs)) publish(frames);
      link_.done(tick);
      result_->done = tick;
      link_.set_times(result_->times);
    }
    while (!link_.over() && !link_.stopped()) link_.wait({}, idle);
  }

  /// Until the tick is granted and its inputs are here. False when the run is over.
  bool await(Tick tick) {
    auto asked = now();
    milliseconds quiet = quiet_patience;
    while (going()) {
      for (const auto& closed : link_.closed()) inbox_.close(closed.topic(), closed.from_tick());
      const bool granted = link_.granted() >= tick;
      if (granted && inbox_.complete(tick)) return true;
      const auto wants = granted ? inbox_.wanted(tick) : std::vector<Inbox::Want>{};
      const bool gap = std::any_of(wants.begin(), wants.end(), [](const auto& w) { return w.gap; });
      const milliseconds patience = gap ? gap_patience : quiet;
      if (!wants.empty() && now() - asked > patience) {
        ask_again(wants);
        asked = now();
        if (!gap) quiet = std::min(2 * quiet, quiet_patience_limit);
      }
      {
        const Stopwatch watch(&result_->times.waiting_s);
        link_.wait(sockets_, wants.empty() ? idle : patience);
      }
      receive_data();
    }
    return false;
  }

  void ask_again(const std::vector<Inbox::Want>& wants) {
    for (const Inbox::Want& want : wants) {
      const std::string& address = resend_of_[want.topic];
      auto [socket, fresh] = askers_.try_emplace(address);
      if (fresh) {
        socket->second = make_socket(data_context_, zmq::socket_type::dealer, max_data_bytes);
        connect_to(socket->second, address);
        sockets_.push_back(&socket->second);
      }
      v1::ResendRequest request;
      request.set_run_id(run_.run_id);
      request.set_topic(want.topic);
      request.set_from_sequence(want.from_sequence);
      socket->second.send(to_frame(request), zmq::send_flags::none);
      ++result_->asked_again;
    }
  }

  void receive_data() {
    if (sockets_.empty()) return;
    const Stopwatch watch(&result_->times.messaging_s);
    for (zmq::socket_t* socket : sockets_)
      for (auto message = receive(*socket); !message.empty(); message = receive(*socket)) {
        // A subscription also matches topics that only begin like it.
        if (!resend_of_.contains(message[0].to_string_view())) continue;
        if (const auto received = receiver_->receive(views(message)))
          inbox_.accept(*received);
        else
          spdlog::warn("refused a message: {}", receiver_->last_refusal());
      }
    result_->refused = receiver_->refused();
    result_->last_refusal = receiver_->last_refusal();
  }

  void publish(const SharedFrames& frames) {
    send(is_direct(frames->topic) ? direct_ : publish_, frames);
  }

  bool going() const { return !link_.over() && !link_.stopped(); }

  void finish() {
    const bool interrupted = link_.stopped() && link_.phase() != v1::PHASE_ENDED;
    for (auto* socket : {&publish_, &direct_, &subscribe_}) socket->close();
    sockets_.clear();
    askers_.clear();
    data_context_.close();  // everything published is on its way before the node leaves
    link_.leave(interrupted, result_->times);
    if (link_.phase() == v1::PHASE_FAILED) throw Error(link_.cause());
    if (interrupted) throw Error("interrupted");
  }

  Participant& participant_;
  const NodeOptions& options_;
  NodeResult* result_ = nullptr;
  std::vector<std::string> produces_, consumes_;
  zmq::context_t control_context_{1}, data_context_{1};
  std::optional<Outbox> outbox_;  // used by the link's keeper: outlives it
  MasterLink link_;
  zmq::socket_t publish_, direct_, subscribe_;
  std::map<std::string, zmq::socket_t> askers_;                // by resend endpoint
  std::map<std::string, std::string, std::less<>> resend_of_;  // of each consumed topic
  std::vector<zmq::socket_t*> sockets_;                        // that data arrive on
  RunFacts run_;
  std::optional<Receiver> receiver_;
  Inbox inbox_;
};

}  // namespace

NodeResult run_node(Participant& participant, const NodeOptions& options) {
  NodeResult result;
  try {
    Node node(participant, options);
    node.run(&result);
  } catch (const ConfigError& error) {
    result.exit_code = 2;
    result.reason = error.what();
  } catch (const std::exception& error) {
    result.exit_code = 1;
    result.reason = error.what();
  }
  if (result.exit_code != 0) spdlog::error("{}", result.reason);
  return result;
}

}  // namespace dmise
