#include "nodes/agent/host_agent.h"

#include <spdlog/spdlog.h>
#include <unistd.h>

#include <mutex>

#include "core/base/error.h"
#include "core/base/whole_file.h"
#include "nodes/agent/host_barrier.h"
#include "nodes/agent/host_publisher.h"
#include "nodes/runtime/master_link/master_link.h"
#include "nodes/runtime/process/cpu_time.h"
#include "nodes/runtime/process/monotonic_clock.h"
#include "nodes/runtime/protocol/control_rules.h"
#include "nodes/runtime/protocol/topic_owners.h"
#include "nodes/runtime/transport/broker_place.h"
#include "nodes/runtime/transport/own_name.h"
#include "nodes/runtime/transport/peer_monitor.h"
#include "nodes/runtime/transport/relay.h"
#include "time-master/master_messages.h"

namespace dmise {
namespace {

using std::chrono::duration;
using std::chrono::duration_cast;
using std::chrono::milliseconds;
using std::chrono::nanoseconds;

constexpr milliseconds check_interval{50};
constexpr milliseconds connecting_interval{10};  // grants repeated while subscribers connect
constexpr milliseconds farewell{1300};  // longest wait for nodes to leave a run that is over
constexpr milliseconds drained{50};     // nothing more comes when it was quiet for so long

/// Another address of the same host.
std::string beside(const std::string& address, const std::string& what) {
  return address.starts_with("tcp://") ? any_port(address) : address + "-" + what;
}

nanoseconds from_seconds(double s) { return duration_cast<nanoseconds>(duration<double>(s)); }

PulseLimits limits_of(const v1::Welcome& welcome) {
  PulseLimits limits;
  limits.silent_after = from_seconds(welcome.silent_after_s());
  limits.heartbeat = from_seconds(welcome.heartbeat_s());
  limits.progress_after = from_seconds(welcome.progress_after_s());
  return limits;
}

v1::NodeNews::What to_wire(HostBarrier::News::What what) {
  switch (what) {
    case HostBarrier::News::What::lost:
      return v1::NodeNews::WHAT_LOST;
    case HostBarrier::News::What::found:
      return v1::NodeNews::WHAT_FOUND;
    case HostBarrier::News::What::failed:
      break;
  }
  return v1::NodeNews::WHAT_FAILED;
}

class HostAgent {
 public:
  HostAgent(const HostAgentOptions& options, HostAgentResult* result)
      : options_(options),
        result_(result),
        security_(serving(Security(options.keys, options.name))),
        door_(context_, security_),
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

  void run() {
    join();
    auto next_check = now();
    auto awake = now();
    std::optional<nanoseconds> over_since;
    while (true) {
      link_.wait({&router_, &publishers_, &subscribers_, &to_broker_, &from_broker_},
                 next_check - now());
      broken_ = connections_.broken();
      suspect(connections_.names_of(broken_));
      hear();
      // What came over a connection before it broke is no sign of life after it.
      suspect(connections_.forget(broken_));
      // Whoever was itself stopped has heard nobody because it could not.
      if (now() - awake > barrier_->limits().silent_after / 2) barrier_->excuse(awake, now());
      awake = now();
      relay();
      take_in();
      const bool due = now() >= next_check;
      if (due) {
        barrier_->check(now());
        for (PeerMonitor* peers : {&connections_, &subscriptions_, &tick_subscriptions_})
          for (const std::string& closed : peers->enforce(now())) spdlog::warn("{}", closed);
        subscriptions_.forget(subscriptions_.broken());
        tick_subscriptions_.forget(tick_subscriptions_.broken());
        note_beats();
        const bool connecting = link_.phase() == v1::PHASE_CONNECTING;
        next_check = now() + (connecting ? connecting_interval : check_interval);
      }
      speak();
      publisher_.say(due && (link_.phase() == v1::PHASE_CONNECTING || over()));
      if (link_.phase() == v1::PHASE_RUNNING && cpu_began_ < 0) cpu_began_ = process_cpu_seconds();
      if (!over()) continue;
      if (cpu_began_ >= 0 && !over_since) result_->cpu_s = process_cpu_seconds() - cpu_began_;
      barrier_->run_is_over();
      if (!over_since) over_since = now();
      const bool quiet = now() - busy_ > drained && now() - *over_since > drained;
      if ((barrier_->deserted() && quiet) || now() - *over_since > farewell) break;
    }
    leave();
  }

 private:
  void join() {
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
    spdlog::debug("joined {}, listens on {}", options_.master, address_);
    if (!options_.announce_file.empty()) write_file_whole(options_.announce_file, address_ + "\n");
    if (options_.announce_fd >= 0) {
      const std::string line = address_ + "\n";
      if (write(options_.announce_fd, line.data(), line.size()) != ssize_t(line.size()))
        throw Error("announce-fd: can't write");
    }
    if (options_.on_bound) options_.on_bound(address_);
  }

  void suspect(const std::vector<std::string>& names) {
    for (const std::string& name : names) barrier_->suspect(name, now());
  }

  bool over() const { return link_.over() || link_.stopped(); }

  /// What the nodes of this host say.
  void hear() {
    for (auto message = receive(router_); !message.empty(); message = receive(router_)) {
      for (std::size_t i = 1; i < message.size(); ++i) connections_.took(message[i]);
      if (message.size() != 2 || !from_frame(message[1], &heard_)) continue;
      const std::string_view sender = message[0].to_string_view();
      auto fault = fault_of(heard_);
      if (!fault && security_.on())
        fault = fault_of_sender(heard_, message[1], directory_.name_of(sender));
      if (fault) {
        spdlog::warn("refused a message: {}", *fault);
        if (heard_.has_join()) publisher_.refuse(sender, *fault);
        continue;
      }
      if (heard_.has_join()) {
        join_of(sender, message[1]);
        continue;
      }
      if (heard_.run_id() != link_.welcome().run_id()) continue;
      const std::string name = directory_.name_of(sender);
      if (heard_.has_heartbeat())
        heartbeat(sender, message[1]);
      else if (name.empty())
        continue;
      else if (heard_.has_done())
        done(name);
      else if (heard_.has_ready())
        barrier_->ready(name, now());
      else if (heard_.has_leave())
        leave_of(name);
      else if (heard_.has_failed())
        barrier_->fail(name, one_line(heard_.failed().reason()));
    }
  }

  void join_of(std::string_view sender, zmq::message_t& frame) {
    const v1::Join& join = heard_.join();
    if (over()) return publisher_.refuse(sender, "the run is over");
    if (join.observer() || join.has_broker() || join.agent() || !join.host().empty())
      return publisher_.refuse(
          sender, "only nodes that keep time join an agent; join " + options_.master + " itself");
    suspect(connections_.names_of(broken_));  // whose last words may have been heard just now
    if (barrier_->knows_living(join.name()))
      return publisher_.refuse(sender, "a node named " + join.name() + " has already joined");
    asking_[join.name()] = {std::string(sender), 0, join};
    connections_.belongs(frame, join.name());
    barrier_->asks(join.name());
    v1::NodeMessage message;
    *message.mutable_join() = join;
    message.mutable_join()->set_host(options_.name);
    link_.say(std::move(message));
  }

  void done(const std::string& name) {
    if (security_.on() && !owners_.keep_own(name, heard_.mutable_done()))
      spdlog::warn("refused what {} tells of topics of others", name);
    barrier_->done(name, tally_of(heard_.done()), now());
    const Peer& peer = directory_.all().at(name);
    for (v1::TopicTally tally : heard_.done().published()) {
      tally.set_tick(heard_.done().tick());
      tally.set_incarnation(peer.incarnation);
      publisher_.note(tally);
    }
  }

  void heartbeat(std::string_view sender, zmq::message_t& frame) {
    const auto& heartbeat = heard_.heartbeat();
    const std::string& name = heartbeat.name();
    const Peer* peer = directory_.find(name, heartbeat.incarnation());
    if (!peer) {
      return publisher_.reply(
          sender, publisher_.expelled(directory_.knows(name)
                                          ? "another process has taken the name " + name
                                          : "the agent " + options_.name + " that " + name +
                                                " joined is gone; another has taken its place"));
    }
    if (!security_.on() && heartbeat.token() != peer->heartbeat_token) return;  // another's
    if (!barrier_->nodes().contains(name))
      return publisher_.reply(sender, publisher_.expelled("the run goes on without " + name));
    connections_.belongs(frame, name);
    barrier_->heartbeat(name, heartbeat.computing(), heartbeat.progress(), now());
    times_[name] = heartbeat.times();
    publisher_.reply(sender, publisher_.grant_for(peer->join));
  }

  void leave_of(const std::string& name) {
    times_[name] = heard_.leave().times();
    barrier_->leave(name, heard_.leave().interrupted());
  }

  /// Data, in both directions.
  void relay() {
    const int out = security_.on()
                        ? pass_checked(publishers_, to_broker_, publishes_itself, &result_->refused)
                        : pass_on(publishers_, to_broker_);
    const int in = pass_on(from_broker_, subscribers_);
    const int asked = pass_subscriptions(subscribers_, from_broker_) +
                      pass_subscriptions(to_broker_, publishers_);
    result_->messages_out += std::uint64_t(out);
    result_->messages_in += std::uint64_t(in);
    if (out + in + asked > 0) busy_ = now();
  }

  /// What the master has said.
  void take_in() {
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

  void welcome(v1::MasterMessage answer) {
    const std::string name =
        answer.has_welcome() ? answer.welcome().name() : answer.refuse().name();
    const auto asked = asking_.find(name);
    if (asked == asking_.end()) return;
    const Peer peer = asked->second;
    asking_.erase(asked);
    if (answer.has_welcome()) {
      auto* welcome = answer.mutable_welcome();
      directory_.add(peer.routing_id, welcome->incarnation(), peer.join,
                     welcome->heartbeat_token());
      owners_.add(peer.join);
      barrier_->join(name, request_of(peer.join).node.schedule, welcome->incarnation(),
                     welcome->resume_tick(), now());
      welcome->set_tick_endpoint(tick_endpoint_);
      said_ready_ = false;
      spdlog::info("{} joined{}", name,
                   welcome->incarnation() == 1
                       ? ""
                       : fmt::format(", process {} of its name", welcome->incarnation()));
    } else {
      barrier_->refused(name);
    }
    publisher_.reply(peer.routing_id, answer);
  }

  void follow_topology() {
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
    publisher_.send_topology(topology, publish_endpoint_, subscribe_endpoint_,
                             security_.password());
  }

  /// Tells the master what there is to tell of this host.
  void speak() {
    for (const HostBarrier::News& news : barrier_->take_news()) {
      v1::NodeMessage message;
      auto* wire = message.mutable_node_news();
      wire->set_what(to_wire(news.what));
      wire->set_name(news.name);
      wire->set_incarnation(news.incarnation);
      wire->set_reason(news.reason);
      wire->set_done_tick(news.done);
      link_.say(std::move(message));
      if (news.what == HostBarrier::News::What::lost) spdlog::warn("{} {}", news.name, news.reason);
      if (news.what == HostBarrier::News::What::lost && link_.phase() == v1::PHASE_GATHERING)
        barrier_->forget(news.name);
    }
    if (over()) return;
    if (!said_ready_ && topology_version_ > 0 && link_.hears_ticks() && barrier_->all_ready()) {
      link_.ready();
      said_ready_ = true;
    }
    while (const auto tally = barrier_->take_done(link_.granted())) tell_done(*tally);
  }

  void tell_done(const TickTally& tally) {
    v1::NodeMessage message;
    auto* done = message.mutable_done();
    done->set_tick(tally.tick);
    done->set_digest(tally.digest);
    for (const TopicTally& topic : tally.topics) {
      if (!reported_.contains(topic.topic)) continue;
      auto* published = done->add_published();
      published->set_topic(topic.topic);
      published->set_messages(topic.messages);
      published->set_last_sequence(topic.last_sequence);
      published->set_digest(topic.digest);
      published->set_incarnation(topic.incarnation);
    }
    link_.say(std::move(message));
  }

  /// For the next heartbeat.
  void note_beats() {
    v1::Heartbeat beats;
    beats.set_progress(++beats_noted_);  // of its nodes' steps it knows itself
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

  void leave() {
    const bool interrupted = link_.stopped() && !link_.over();
    note_beats();
    v1::NodeMessage message;
    message.mutable_leave()->set_interrupted(interrupted);
    *message.mutable_leave()->mutable_nodes() = beats_.nodes();
    link_.say(std::move(message));
    if (link_.phase() == v1::PHASE_FAILED) throw Error(link_.cause());
    if (interrupted) throw Error("interrupted");
  }

  const HostAgentOptions& options_;
  HostAgentResult* result_;
  zmq::context_t context_{1};
  Security security_;
  ZapAuthenticator door_;
  std::mutex mutex_;     // guards beats_
  v1::Heartbeat beats_;  // used by the link's heartbeat: outlives it
  MasterLink link_;
  zmq::socket_t router_, ticks_;            // the nodes' time-master
  zmq::socket_t publishers_, subscribers_;  // the nodes' broker
  zmq::socket_t to_broker_, from_broker_;   // the run's
  PeerMonitor connections_, subscriptions_, tick_subscriptions_;
  std::vector<std::uint64_t> broken_;  // of these, as of now
  PeerDirectory directory_;
  TopicOwners owners_;
  HostPublisher publisher_;
  std::optional<HostBarrier> barrier_;
  std::map<std::string, Peer> asking_;  // nodes whose Join the master has not answered
  std::map<std::string, v1::TimeSplit> times_;
  std::set<std::string, std::less<>> reported_;  // topics whose tallies the master wants
  std::string address_, tick_endpoint_, publish_endpoint_, subscribe_endpoint_;
  BrokerPlace at_subscribe_{from_broker_}, at_publish_{to_broker_};
  std::uint64_t topology_version_ = 0;
  v1::NodeMessage heard_;
  nanoseconds busy_{0};
  std::uint64_t beats_noted_ = 0;
  double cpu_began_ = -1.0;
  bool said_ready_ = false;
};

}  // namespace

HostAgentResult run_host_agent(const HostAgentOptions& options) {
  HostAgentResult result;
  try {
    HostAgent(options, &result).run();
  } catch (const ConfigError& error) {
    result.exit_code = 2;
    result.reason = error.what();
    spdlog::error("{}", result.reason);
  } catch (const std::exception& error) {
    result.exit_code = 1;
    result.reason = error.what();
    spdlog::error("{}", result.reason);
  }
  return result;
}

}  // namespace dmise
