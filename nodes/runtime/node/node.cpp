#include "nodes/runtime/node/node.h"

#include <spdlog/spdlog.h>

#include <algorithm>

#include "core/base/error.h"
#include "core/base/stopwatch.h"
#include "nodes/runtime/master_link/master_link.h"
#include "nodes/runtime/master_link/run_result.h"
#include "nodes/runtime/node/frame_server.h"
#include "nodes/runtime/node/node_inputs.h"
#include "nodes/runtime/observability/metrics.h"
#include "nodes/runtime/process/json_log.h"
#include "nodes/runtime/process/monotonic_clock.h"
#include "nodes/runtime/process/process_memory.h"
#include "nodes/runtime/process/seconds.h"
#include "nodes/runtime/transport/broker_connection.h"
#include "nodes/runtime/transport/peer_monitor.h"

namespace dmise {
namespace {

using std::chrono::milliseconds;
using std::chrono::nanoseconds;

constexpr milliseconds probe_interval{10};  // at first; twice as long each time
// So that the probes of hundreds of nodes leave time to start.
constexpr milliseconds longest_probe_interval{320};
constexpr milliseconds node_idle{1000};
constexpr milliseconds last_answers{1000};    // longest pause of a reader before its last request
constexpr milliseconds limits_interval{100};  // between checks of connection limits

bool is_direct(const std::string& topic) { return topic.starts_with(truth_prefix); }

void count(const std::vector<Message>& published, TimeSplit* made) {
  for (const Message& message : published) {
    made->frames += std::holds_alternative<FrameReport>(*message.state);
    if (const auto* set = std::get_if<DetectionSet>(message.state.get()))
      made->detections += set->detections.size();
  }
}

class Node {
 public:
  Node(Participant& participant, const NodeOptions& options)
      : participant_(participant),
        options_(options),
        schedule_(participant.schedule()),
        produces_(participant.produces()),
        consumes_(participant.consumes()),
        name_(options.name.empty() ? participant.name() : options.name),
        security_(options.keys, name_, options.via),
        control_authenticator_(control_context_, security_),
        data_authenticator_(std::in_place, data_context_, security_),
        link_(control_context_, options.master, options.stop, security_),
        publish_(make_socket(data_context_, zmq::socket_type::pub, max_data_bytes)),
        direct_(make_socket(data_context_, zmq::socket_type::pub, max_data_bytes)),
        inputs_(data_context_, consumes_, security_) {
    publish_.set(zmq::sockopt::linger, 1000);
    direct_.set(zmq::sockopt::linger, 1000);
    direct_.set(zmq::sockopt::sndhwm, max_unread);
    inputs_.set_may_miss(options.observer);
    inputs_.lose_every(options.lose_every);
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
    request.set_name(name_);
    for (const std::string& topic : produces_)
      *(is_direct(topic) ? request.add_produces_direct() : request.add_produces()) = topic;
    for (const std::string& topic : consumes_) {
      request.add_consumes(topic);
      const Tick delay = participant_.delay(topic);
      if (delay == 0) continue;
      inputs_.set_delay(topic, delay, delay + schedule_.period - 1);
      auto* late = request.add_delays();
      late->set_topic(topic);
      late->set_delay_ticks(std::uint64_t(delay));
    }
    request.set_observer(options_.observer);
    request.set_look_back_ticks(std::uint64_t(participant_.look_back()));
    request.set_period_ticks(std::uint64_t(schedule_.period));
    request.set_offset_ticks(std::uint64_t(schedule_.offset));
    for (const std::string& topic : produces_) {
      const Schedule own = participant_.schedule_of(topic);
      if (own == schedule_) continue;
      auto* schedule = request.add_schedules();
      schedule->set_topic(topic);
      schedule->set_period_ticks(std::uint64_t(own.period));
      schedule->set_offset_ticks(std::uint64_t(own.offset));
    }
    if (request.produces_direct_size() > 0) {
      listeners_.emplace(data_context_, direct_, bytes_alone(max_subscriptions_bytes));
      request.set_direct_endpoint(bind_to(direct_, options_.host, security_, Domain::truth));
    }
    std::optional<zmq::socket_t> resend;
    if (!produces_.empty()) {
      resend = make_socket(control_context_, zmq::socket_type::router, max_question_bytes);
      resend->set(zmq::sockopt::sndhwm, max_unread_answers);
      request.set_resend_endpoint(bind_to(*resend, options_.host, security_, Domain::data));
    }
    std::optional<zmq::socket_t> frames;
    if (options_.frames) {
      frames = FrameServer::make_socket_of(control_context_);
      request.set_frames_endpoint(bind_to(*frames, options_.host, security_, Domain::data));
    }

    const auto within = from_seconds(options_.join_within_s);
    const v1::Welcome welcome = link_.join(request, within);
    run_ = {welcome.run_id(), {welcome.tick_ns()}, welcome.last_tick()};
    incarnation_ = welcome.incarnation();
    inputs_.start(run_);
    outbox_.emplace(run_, request.name(), incarnation_, produces_,
                    Tick(welcome.window_ticks()) + 1);
    for (const std::string& topic : produces_)
      outbox_->set_schedule(topic, participant_.schedule_of(topic));
    HeartbeatOptions heartbeat;
    heartbeat.stop_within = from_seconds(options_.stop_within_s);
    heartbeat.progress = [this] { return participant_.progress(); };
    heartbeat.resend = [this](const v1::ResendRequest& request) {
      return request.catch_up() ? outbox_->catch_up(request.topic(), request.from_tick())
                                : outbox_->since(request.topic(), request.from_sequence());
    };
    link_.keep(std::move(heartbeat), std::move(resend));
    if (frames)
      frames_.emplace(control_context_, std::move(*frames), *options_.frames, run_.run_id);
    spdlog::debug("joined {}", options_.master);
  }

  /// Connects to all publishers and waits for the start, or catches up with a run under way. False
  /// if the run is over before.
  bool gather() {
    while (!link_.topology() && going()) link_.wait({}, node_idle);
    if (!going()) return false;
    const v1::Topology first = *link_.topology();
    resume_tick_ = first.resume_tick();
    from_tick_ = first.from_tick();
    for (const auto& publisher : first.publishers())
      if (publisher.incarnation() == incarnation_ && publisher.name() == link_.name())
        outbox_->keep(Tick(publisher.keep_ticks()));
    connect_data();
    inputs_.begin_at(first_input(), resume_tick_, first.running());
    const auto probes = outbox_->probes();
    bool said_ready = false;
    nanoseconds next_probe = now(), interval = probe_interval;
    while (link_.phase() != v1::PHASE_RUNNING && going()) {
      if (now() >= next_probe) {
        for (const SharedFrames& probe : probes) publish(probe);
        next_probe = now() + interval;
        interval = std::min<nanoseconds>(2 * interval, longest_probe_interval);
      }
      link_.wait(inputs_.sockets(), next_probe - now());
      follow_topology();
      inputs_.update_topics(link_.closed(), {});
      receive_data();
      if (!said_ready && (inputs_.probed() || first.running()) && link_.receives_ticks()) {
        result_->times.start_s = process_age_s();
        link_.set_times(result_->times);
        link_.ready();
        said_ready = true;
      }
    }
    return going();
  }

  Tick first_input() const {
    return std::max<Tick>(0, from_tick_ - participant_.look_back() - (schedule_.period - 1));
  }

  void connect_data() {
    const v1::Topology& topology = *link_.topology();
    topology_version_ = link_.topology_version();
    inputs_.connect(topology);
    if (!std::ranges::all_of(produces_, is_direct))
      broker_.follow(topology.publish_endpoint(), topology.broker_incarnation(), security_,
                     topology.broker_password());
  }

  void follow_topology() {
    if (link_.topology_version() != topology_version_) connect_data();
  }

  void work() {
    std::vector<Message> carried = resume_participant();  // published with the first step's
    for (Tick tick = schedule_.next_after(from_tick_ - 1); tick <= run_.last_tick;
         tick = schedule_.next_after(tick)) {
      if (!await(tick)) return;
      need_inputs_of(tick);
      const std::vector<Message> inputs = inputs_.take(tick);
      std::vector<Message> outputs = std::move(carried);
      carried.clear();
      for (Message& message : outputs) message.tick = tick;
      {
        const Stopwatch watch(result_->times.compute_s);
        link_.set_computing(true);
        update_metrics(true);
        for (Message& message : participant_.step(tick, inputs))
          outputs.push_back(std::move(message));
        link_.set_computing(false);
      }
      if (link_.stopped()) return;  // an interrupted step may be incomplete
      const Stopwatch watch(result_->times.messaging_s);
      for (const SharedFrames& frames : outbox_->pack(tick, outputs)) publish(frames);
      count(outputs, &result_->times);
      if (tick >= resume_tick_) link_.done(outbox_->tally());
      result_->done = tick;
      ++steps_;
      link_.set_times(result_->times);
      update_metrics(false);
    }
    while (!link_.over() && !link_.stopped()) {
      link_.wait({}, node_idle);
      follow_topology();
    }
  }

  /// Throws if the run continues without a publisher that the participant needs.
  void need_inputs_of(Tick tick) const {
    for (const auto& topic : link_.closed())
      if (tick >= Tick(topic.from_tick()) && inputs_.consumes(topic.topic()) &&
          participant_.needs(topic.topic()))
        throw Error("nothing is published on " + topic.topic() + " from tick " +
                    std::to_string(topic.from_tick()) + " on");
  }

  /// After a restart, or at the end of an earlier run: gives the participant the inputs it needs to
  /// continue. Its first tick may be 0 then: what it repeats for others begins there.
  std::vector<Message> resume_participant() {
    if (incarnation_ == 1 && resume_tick_ == 0) return {};
    std::vector<Message> past;
    if (!consumes_.empty() && first_input() < from_tick_) {
      if (!await(from_tick_ - 1)) return {};
      past = inputs_.take(from_tick_ - 1);
    }
    log_event(spdlog::level::info, "resumed", {{"tick", std::int64_t(from_tick_)}},
              fmt::format("resumes at tick {}", from_tick_));
    link_.set_computing(true);
    auto carried = participant_.resume(from_tick_, past);
    link_.set_computing(false);
    return carried;
  }

  /// Waits until the tick is granted and its inputs are complete. False if the run is over.
  bool await(Tick tick) {
    inputs_.reset_patience();
    while (going()) {
      follow_topology();
      inputs_.update_topics(link_.closed(), link_.take_published());
      const bool granted = link_.granted() >= tick || tick < resume_tick_;
      if (granted && inputs_.complete(tick)) return true;
      const nanoseconds patience = granted ? inputs_.ask_for(tick) : nanoseconds(node_idle);
      {
        const Stopwatch watch(result_->times.waiting_s);
        link_.wait(inputs_.sockets(), patience);
      }
      receive_data();
      update_metrics(false);
    }
    return false;
  }

  void receive_data() {
    const Stopwatch watch(result_->times.messaging_s);
    inputs_.receive();
    if (listeners_ && now() >= next_look_) {
      for (const std::string& closed : listeners_->enforce(now())) spdlog::warn("{}", closed);
      listeners_->forget(listeners_->broken());
      next_look_ = now() + limits_interval;
    }
  }

  void publish(const SharedFrames& frames) {
    send(is_direct(frames->topic) ? direct_ : publish_, frames);
    ++sent_;
    sent_bytes_ += frames->bytes();
  }

  void update_metrics(bool computing) const {
    Metrics* metrics = Metrics::of_process();
    if (!metrics) return;
    NodeFigures figures = inputs_.figures();
    figures.granted = link_.granted();
    figures.done = result_->done;
    figures.computing = computing;
    figures.incarnation = incarnation_;
    figures.ticks = steps_;
    figures.sent = sent_;
    figures.sent_bytes = sent_bytes_;
    figures.times = result_->times;
    metrics->set(figures);
  }

  bool going() const { return !link_.over() && !link_.stopped(); }

  void finish() {
    result_->refused = inputs_.refused();
    result_->last_refusal = inputs_.last_refusal();
    result_->resend_requests = inputs_.resend_requests();
    result_->resend_requests_known = inputs_.resend_requests_known();
    result_->lost = inputs_.lost();
    result_->missed = inputs_.missed();
    const bool interrupted = link_.stopped() && link_.phase() != v1::PHASE_ENDED;
    publish_.close();
    listeners_.reset();
    direct_.close();
    inputs_.close();
    data_authenticator_.reset();
    data_context_.close();  // flushes everything published before the node leaves
    link_.leave(interrupted, result_->times);
    if (frames_) frames_->finish(interrupted ? nanoseconds(0) : last_answers);
    if (link_.phase() == v1::PHASE_FAILED) throw Error(link_.cause());
    if (interrupted) throw Error("interrupted");
  }

  Participant& participant_;
  const NodeOptions& options_;
  NodeResult* result_ = nullptr;
  Schedule schedule_;
  std::vector<std::string> produces_, consumes_;
  std::string name_;
  Security security_;
  zmq::context_t control_context_{1}, data_context_{1};
  ZapAuthenticator control_authenticator_;
  std::optional<ZapAuthenticator> data_authenticator_;
  std::optional<Outbox> outbox_;  // used by the heartbeat thread, must outlive it
  MasterLink link_;
  zmq::socket_t publish_, direct_;
  std::optional<PeerMonitor> listeners_;  // who is connected to `direct_`
  nanoseconds next_look_{0};
  std::optional<FrameServer> frames_;
  BrokerConnection broker_{publish_};
  NodeInputs inputs_;
  RunFacts run_;
  std::uint64_t incarnation_ = 1, topology_version_ = 0;
  Tick resume_tick_ = 0, from_tick_ = 0;
  std::uint64_t steps_ = 0, sent_ = 0, sent_bytes_ = 0;
};

}  // namespace

NodeResult run_node(Participant& participant, const NodeOptions& options) {
  return result_of_run<NodeResult>(
      [&](NodeResult* result) { Node(participant, options).run(result); });
}

}  // namespace dmise
