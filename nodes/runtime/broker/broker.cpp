#include "nodes/runtime/broker/broker.h"

#include <spdlog/spdlog.h>

#include "core/base/error.h"
#include "nodes/runtime/master_link/master_link.h"
#include "nodes/runtime/observability/metrics.h"
#include "nodes/runtime/observability/status.h"
#include "nodes/runtime/process/monotonic_clock.h"
#include "nodes/runtime/transport/peer_monitor.h"
#include "nodes/runtime/transport/relay.h"

namespace dmise {
namespace {

using std::chrono::duration;
using std::chrono::duration_cast;
using std::chrono::milliseconds;
using std::chrono::nanoseconds;

constexpr milliseconds look_interval{50};  // at who sends too much
constexpr milliseconds drained{100};       // nothing more comes when it was quiet for so long

/// Where an earlier broker of this run was bound, so that nobody has to look for the new one.
BrokerEndpoints earlier_broker(const BrokerOptions& options) {
  try {
    return ask_master(options.master, std::min(options.join_within_s, 2.0),
                      Security(options.keys, broker_name))
        .broker;
  } catch (const Error&) {
    return {};  // the master is starting; joining will tell
  }
}

std::string bind_again(zmq::socket_t& socket, const std::string& earlier,
                       const std::string& configured, const Security& security, Domain domain) {
  if (!earlier.empty()) try {
      return bind_to(socket, earlier, security, domain);
    } catch (const Error&) {
      // Taken by somebody else: all will be told the new address.
    }
  return bind_to(socket, configured, security, domain);
}

void serve(const BrokerOptions& options, BrokerResult* result) {
  const Security security = serving(Security(options.keys, broker_name));
  zmq::context_t context(1);
  const ZapAuthenticator door(context, security);
  zmq::socket_t publishers = make_socket(context, zmq::socket_type::xsub, max_data_bytes);
  zmq::socket_t subscribers = make_socket(context, zmq::socket_type::xpub, max_data_bytes);
  subscribers.set(zmq::sockopt::linger, 500);

  PeerMonitor subscriptions(context, subscribers, bytes_alone(max_subscriptions_bytes));

  // The limit on a queue, and who may come in, is that of the moment when an endpoint is bound.
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
  link.join(join, duration_cast<nanoseconds>(duration<double>(options.join_within_s)));
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
    link.take_published();  // manifests, which are nothing to a broker
    const int forward = security.on() ? pass_checked(publishers, subscribers,
                                                     publishes_or_is_passed_on, &result->refused)
                                      : pass_on(publishers, subscribers);
    const int back = pass_subscriptions(subscribers, publishers);
    result->messages += std::uint64_t(forward);
    if (forward + back > 0) busy = now();
    if (Metrics* metrics = Metrics::of_process())
      metrics->tell(BrokerFigures{.messages = result->messages, .refused = result->refused});
  }
  const bool interrupted = link.stopped() && !link.over();
  link.leave(interrupted, {});
  if (link.phase() == v1::PHASE_FAILED) throw Error(link.cause());
  if (interrupted) throw Error("interrupted");
}

}  // namespace

BrokerResult run_broker(const BrokerOptions& options) {
  BrokerResult result;
  try {
    serve(options, &result);
  } catch (const std::exception& error) {
    result.exit_code = 1;
    result.reason = error.what();
    spdlog::error("{}", result.reason);
  }
  return result;
}

}  // namespace dmise
