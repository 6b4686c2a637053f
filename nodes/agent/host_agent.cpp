#include "nodes/agent/host_agent.h"

#include <spdlog/spdlog.h>

#include "core/base/error.h"
#include "nodes/agent/host_agent_process.h"
#include "nodes/runtime/master_link/run_result.h"
#include "nodes/runtime/process/monotonic_clock.h"
#include "nodes/runtime/process/process_memory.h"
#include "nodes/runtime/process/seconds.h"
#include "nodes/runtime/transport/relay.h"
#include "time-master/announce.h"

namespace dmise {
namespace {

using std::chrono::milliseconds;
using std::chrono::nanoseconds;

constexpr milliseconds check_interval{50};
constexpr milliseconds connecting_interval{10};  // grants repeated while subscribers connect
constexpr milliseconds farewell{1300};           // longest wait for nodes to leave after the run
constexpr milliseconds drained{50};              // silence after which the sockets count as drained

/// Another address on the same host.
std::string beside(const std::string& address, const std::string& what) {
  return address.starts_with("tcp://") ? any_port(address) : address + "-" + what;
}

PulseLimits limits_of(const v1::Welcome& welcome) {
  return {.silent_after = from_seconds(welcome.silent_after_s()),
          .heartbeat = from_seconds(welcome.heartbeat_s()),
          .progress_after = from_seconds(welcome.progress_after_s())};
}

static_assert(int(HostBarrier::News::What::lost) == v1::NodeNews::WHAT_LOST &&
              int(HostBarrier::News::What::failed) == v1::NodeNews::WHAT_FAILED);

}  // namespace

HostAgentProcess::HostAgentProcess(const HostAgentOptions& options, HostAgentResult* result)
    : options_(options),
      result_(result),
      security_(serving(Security(options.keys, options.name))),
      authenticator_(context_, security_),
      link_(context_, options.master, options.stop, security_),
      router_(make_socket(context_, zmq::socket_type::router, max_control_bytes)),
      ticks_(make_socket(context_, zmq::socket_type::pub, max_control_bytes)),
      publishers_(make_socket(context_, zmq::socket_type::xsub, max_data_bytes)),
      subscribers_(make_socket(context_, zmq::socket_type::xpub, max_data_bytes)),
      to_broker_(make_socket(context_, zmq::socket_type::xpub, max_data_bytes)),
      from_broker_(make_socket(context_, zmq::socket_type::xsub, max_data_bytes)),
      connections_(context_, router_, bytes_alone(max_unheard_bytes)),
      subscriptions_(context_, subscribers_, bytes_alone(max_subscriptions_bytes)),
      tick_subscriptions_(context_, ticks_, bytes_alone(max_subscriptions_bytes)),
      publisher_(router_, ticks_, directory_) {
  for (auto* socket : {&router_, &ticks_, &subscribers_}) socket->set(zmq::sockopt::linger, 500);
  to_broker_.set(zmq::sockopt::linger, 1000);
  ticks_.set(zmq::sockopt::sndhwm, max_unread);
  const std::string& bind = options.bind;
  address_ = bind_to(router_, bind, security_);
  tick_endpoint_ = bind_to(ticks_, beside(bind, "ticks"), security_);
  publish_endpoint_ = bind_to(publishers_, beside(bind, "publish"), security_, Domain::run);
  subscribe_endpoint_ = bind_to(subscribers_, beside(bind, "subscribe"), security_, Domain::run);
}

void HostAgentProcess::run() {
  join();
  auto next_check = now();
  auto awake = now();
  std::optional<nanoseconds> over_since;
  while (true) {
    link_.wait({&router_, &publishers_, &subscribers_, &to_broker_, &from_broker_},
               next_check - now());
    broken_ = connections_.broken();
    suspect(connections_.names_of(broken_));
    handle_nodes();
    // Messages received before a connection broke are not signs of life after it.
    suspect(connections_.forget(broken_));
    // While this process was suspended it could not receive anything.
    if (now() - awake > barrier_->limits().silent_after / 2) barrier_->excuse(awake, now());
    awake = now();
    relay();
    apply_grant();
    const bool due = now() >= next_check;
    if (due) {
      barrier_->check(now());
      for (PeerMonitor* peers : {&connections_, &subscriptions_, &tick_subscriptions_})
        for (const std::string& closed : peers->enforce(now())) spdlog::warn("{}", closed);
      subscriptions_.forget(subscriptions_.broken());
      tick_subscriptions_.forget(tick_subscriptions_.broken());
      collect_beats();
      const bool connecting = link_.phase() == v1::PHASE_CONNECTING;
      next_check = now() + (connecting ? connecting_interval : check_interval);
    }
    report_to_master();
    publisher_.publish(due && (link_.phase() == v1::PHASE_CONNECTING || over()));
    if (link_.phase() == v1::PHASE_RUNNING && cpu_began_ < 0) cpu_began_ = process_cpu_s();
    if (!over()) continue;
    if (cpu_began_ >= 0 && !over_since) result_->cpu_s = process_cpu_s() - cpu_began_;
    barrier_->run_is_over();
    if (!over_since) over_since = now();
    const bool quiet = now() - busy_ > drained && now() - *over_since > drained;
    if ((barrier_->deserted() && quiet) || now() - *over_since > farewell) break;
  }
  leave();
}

void HostAgentProcess::join() {
  v1::Join request;
  request.set_name(options_.name);
  request.set_agent(true);
  const v1::Welcome welcome = link_.join(request, from_seconds(options_.join_within_s));
  barrier_.emplace(limits_of(welcome));
  HeartbeatOptions heartbeat;
  heartbeat.add_to_heartbeat = [this](v1::Heartbeat* heartbeat) {
    const std::lock_guard lock(mutex_);
    heartbeat->MergeFrom(beats_);
  };
  link_.keep(std::move(heartbeat), std::nullopt);
  link_.on_return([this] { repeat_reports(); });
  spdlog::debug("joined {}, listens on {}", options_.master, address_);
  announce(address_, options_.announce_file, options_.announce_fd, options_.on_bound);
}

void HostAgentProcess::suspect(const std::vector<std::string>& names) {
  for (const std::string& name : names) barrier_->suspect(name, now());
}

void HostAgentProcess::relay() {
  const int out = security_.on()
                      ? relay_checked(publishers_, to_broker_, publishes_itself, &result_->refused)
                      : relay_messages(publishers_, to_broker_);
  const int in = relay_messages(from_broker_, subscribers_);
  const int subscriptions = relay_subscriptions(subscribers_, from_broker_) +
                            relay_subscriptions(to_broker_, publishers_);
  result_->messages_out += std::uint64_t(out);
  result_->messages_in += std::uint64_t(in);
  if (out + in + subscriptions > 0) busy_ = now();
}

void HostAgentProcess::apply_grant() {
  for (const v1::MasterMessage& answer : link_.take_answers()) welcome(answer);
  if (link_.topology_version() != topology_version_) follow_topology();
  v1::Grant grant;
  grant.set_run_id(link_.welcome().run_id());
  grant.set_tick(link_.granted());
  grant.set_phase(over() && !link_.over() ? v1::PHASE_FAILED : link_.phase());
  grant.set_cause(over() && !link_.over() ? options_.name + " was interrupted" : link_.cause());
  for (const v1::ClosedTopic& topic : link_.closed()) *grant.add_closed() = topic;
  const Tick settled = link_.granted() - Tick(link_.welcome().window_ticks());
  barrier_->settled(settled);
  publisher_.set_grant(std::move(grant), settled);
  for (const v1::TopicTally& tally : link_.take_published()) publisher_.note(tally);
}

void HostAgentProcess::follow_topology() {
  topology_version_ = link_.topology_version();
  const v1::Topology& topology = *link_.topology();
  reported_ = {topology.reported().begin(), topology.reported().end()};
  std::set<std::string> names;
  for (const v1::NodeStart& start : topology.starts()) names.insert(start.name());
  barrier_->expects(std::move(names));
  const std::string& password = topology.broker_password();
  at_subscribe_.follow(topology.subscribe_endpoint(), topology.broker_incarnation(), security_,
                       password);
  at_publish_.follow(topology.publish_endpoint(), topology.broker_incarnation(), security_,
                     password);
  send_topology();
}

void HostAgentProcess::send_topology(const std::string& only) {
  publisher_.send_topology(*link_.topology(), publish_endpoint_, subscribe_endpoint_,
                           security_.password(), only);
}

void HostAgentProcess::repeat_reports() {
  barrier_->repeat_news();
  send_news();
  for (const auto& [name, peer] : joining_) forward(peer.join);
}

void HostAgentProcess::send_news() {
  for (const HostBarrier::News& news : barrier_->take_news()) {
    v1::NodeMessage message;
    auto* wire = message.mutable_node_news();
    wire->set_what(static_cast<v1::NodeNews::What>(news.what));
    wire->set_name(news.name);
    wire->set_incarnation(news.incarnation);
    wire->set_reason(news.reason);
    wire->set_done_tick(news.done);
    link_.send(std::move(message));
    if (news.what == HostBarrier::News::What::lost) spdlog::warn("{} {}", news.name, news.reason);
    if (news.what == HostBarrier::News::What::lost && link_.phase() == v1::PHASE_GATHERING)
      barrier_->forget(news.name);
  }
}

void HostAgentProcess::report_to_master() {
  send_news();
  if (over()) return;
  if (!said_ready_ && topology_version_ > 0 && link_.receives_ticks() && barrier_->all_ready()) {
    link_.ready();
    said_ready_ = true;
  }
  while (auto tally = barrier_->take_done(link_.granted())) {
    std::erase_if(tally->topics,
                  [this](const TopicTally& topic) { return !reported_.contains(topic.topic); });
    link_.done(*tally);
  }
}

void HostAgentProcess::collect_beats() {
  v1::Heartbeat beats;
  beats.set_progress(++beats_noted_);  // the agent itself has no steps
  for (const auto& [name, node] : barrier_->nodes()) {
    if (node.pulse.computing) beats.set_computing(true);
    auto* beat = beats.add_nodes();
    beat->set_name(name);
    beat->set_done_tick(node.done);
    if (const auto times = times_.find(name); times != times_.end())
      *beat->mutable_times() = times->second;
  }
  for (const std::string& name : barrier_->holding()) beats.add_holding(name);
  const std::lock_guard lock(mutex_);
  beats_.Swap(&beats);
}

void HostAgentProcess::leave() {
  const bool interrupted = link_.stopped() && !link_.over();
  collect_beats();
  v1::NodeMessage message;
  message.mutable_leave()->set_interrupted(interrupted);
  *message.mutable_leave()->mutable_nodes() = beats_.nodes();
  link_.send(std::move(message));
  if (link_.phase() == v1::PHASE_FAILED) throw Error(link_.cause());
  if (interrupted) throw Error("interrupted");
}

HostAgentResult run_host_agent(const HostAgentOptions& options) {
  return result_of_run<HostAgentResult>(
      [&](HostAgentResult* result) { HostAgentProcess(options, result).run(); });
}

}  // namespace dmise
