#include "nodes/runtime/broker/broker.h"

#include <spdlog/spdlog.h>

#include "core/base/error.h"
#include "nodes/runtime/master_link/master_link.h"
#include "nodes/runtime/master_link/run_result.h"
#include "nodes/runtime/observability/metrics.h"
#include "nodes/runtime/observability/status.h"
#include "nodes/runtime/process/monotonic_clock.h"
#include "nodes/runtime/process/seconds.h"
#include "nodes/runtime/transport/peer_monitor.h"
#include "nodes/runtime/transport/relay.h"

namespace dmise {
namespace {

using std::chrono::milliseconds;

constexpr milliseconds look_interval{50};  // between checks of connection limits
constexpr milliseconds drained{100};       // silence after which the sockets count as drained

/// Endpoints of an earlier broker of this run, reused so that connections need not change.
BrokerEndpoints earlier_broker(const BrokerOptions& options) {
  try {
    return ask_master(options.master, std::min(options.join_within_s, 2.0),
                      Security(options.keys, broker_name))
        .broker;
  } catch (const Error&) {
    return {};  // the master is starting; joining will show
  }
}

std::string bind_again(zmq::socket_t& socket, const std::string& earlier,
                       const std::string& configured, const Security& security, Domain domain) {
  if (!earlier.empty()) try {
      return bind_to(socket, earlier, security, domain);
    } catch (const Error&) {
      // Taken by another process: nodes receive the new address.
    }
  return bind_to(socket, configured, security, domain);
}

void serve(const BrokerOptions& options, BrokerResult* result) {
  const Security security = serving(Security(options.keys, broker_name));
  zmq::context_t context(1);
  const ZapAuthenticator authenticator(context, security);
  zmq::socket_t publishers = make_socket(context, zmq::socket_type::xsub, max_data_bytes);
  zmq::socket_t subscribers = make_socket(context, zmq::socket_type::xpub, max_data_bytes);
  subscribers.set(zmq::sockopt::linger, 500);

  PeerMonitor subscriptions(context, subscribers, bytes_alone(max_subscriptions_bytes));

  // Queue limits and access are those at the time of binding an endpoint.
  v1::Join join;
  join.set_name(broker_name);
  const BrokerEndpoints earlier = earlier_broker(options);
  auto* endpoints = join.mutable_broker();
  subscribers.set(zmq::sockopt::sndhwm, options.observer_queue);
  endpoints->set_observe_endpoint(
      bind_again(subscribers, earlier.observe, options.observe, security, Domain::data));
  subscribers.set(zmq::sockopt::sndhwm, 0);
  endpoints->set_subscribe_endpoint(
      bind_again(subscribers, earlier.subscribe, options.subscribe, security, Domain::run));
  endpoints->set_publish_endpoint(
      bind_again(publishers, earlier.publish, options.publish, security, Domain::run));
  endpoints->set_password(security.password());

  MasterLink link(context, options.master, options.stop, security);
  link.join(join, from_seconds(options.join_within_s));
  link.keep({}, std::nullopt);

  auto busy = now();
  auto next_look = busy;
  const std::vector<zmq::socket_t*> sockets{&publishers, &subscribers};
  const auto finished = [&] {
    if (link.phase() == v1::PHASE_FAILED || link.stopped()) return true;
    return link.deserted() && now() - busy > drained;
  };
  while (!finished()) {
    link.wait(sockets, link.deserted() ? drained : look_interval);
    if (now() >= next_look) {
      for (const std::string& closed : subscriptions.enforce(now())) spdlog::warn("{}", closed);
      subscriptions.forget(subscriptions.broken());
      next_look = now() + look_interval;
    }
    link.take_published();  // manifests, which a broker ignores
    const int forward = security.on() ? relay_checked(publishers, subscribers,
                                                      publishes_or_is_forwarded, &result->refused)
                                      : relay_messages(publishers, subscribers);
    const int back = relay_subscriptions(subscribers, publishers);
    result->messages += std::uint64_t(forward);
    if (forward + back > 0) busy = now();
    if (Metrics* metrics = Metrics::of_process())
      metrics->set(BrokerFigures{.messages = result->messages, .refused = result->refused});
  }
  const bool interrupted = link.stopped() && !link.over();
  link.leave(interrupted, {});
  if (link.phase() == v1::PHASE_FAILED) throw Error(link.cause());
  if (interrupted) throw Error("interrupted");
}

}  // namespace

BrokerResult run_broker(const BrokerOptions& options) {
  return result_of_run<BrokerResult>([&](BrokerResult* result) { serve(options, result); });
}

}  // namespace dmise
