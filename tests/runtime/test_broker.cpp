// The broker of a run whose time-master goes away.
#include <gtest/gtest.h>

#include "dmise/v1/node.pb.h"
#include "dmise/v1/time.pb.h"
#include "nodes/runtime/transport/socket.h"
#include "tests/runtime/network_threads.h"

namespace dmise {
namespace {

constexpr std::uint64_t run_id = 7;

/// Answers the broker as a time-master does until it has said that the run has ended, and no more:
/// not that all have left.
void end_without_farewell(zmq::socket_t& router, const std::string& tick_endpoint) {
  for (bool told = false; !told;) {
    zmq::pollitem_t items[] = {{router.handle(), 0, ZMQ_POLLIN, 0}};
    ASSERT_EQ(zmq::poll(items, 1, std::chrono::seconds(20)), 1);
    auto message = receive(router);
    v1::NodeMessage asked;
    ASSERT_TRUE(message.size() == 2 && from_frame(message[1], &asked));
    v1::MasterMessage answer;
    if (asked.has_hello()) {
      answer.mutable_endpoints()->set_run_id(run_id);
    } else if (asked.has_join()) {
      auto* welcome = answer.mutable_welcome();
      welcome->set_run_id(run_id);
      welcome->set_name(asked.join().name());
      welcome->set_incarnation(1);
      welcome->set_tick_ns(1'000'000'000);
      welcome->set_window_ticks(1);
      welcome->set_heartbeat_s(0.05);
      welcome->set_silent_after_s(120.0);
      welcome->set_tick_endpoint(tick_endpoint);
    } else if (asked.has_heartbeat()) {
      answer.mutable_grant()->set_run_id(run_id);
      answer.mutable_grant()->set_phase(v1::PHASE_ENDED);
      told = true;
    }
    router.send(message[0], zmq::send_flags::sndmore);
    router.send(to_frame(answer), zmq::send_flags::none);
  }
}

TEST(Broker, EndsWhenTheTimeMasterIsGoneAfterTheEndOfTheRun) {
  zmq::context_t context(1);
  auto router = make_socket(context, zmq::socket_type::router, max_control_bytes);
  auto ticks = make_socket(context, zmq::socket_type::pub, max_control_bytes);
  router.set(zmq::sockopt::linger, 1000);
  const std::string address = bind_to(router, "tcp://127.0.0.1:0");
  const std::string tick_endpoint = bind_to(ticks, "tcp://127.0.0.1:0");
  auto broker = test::start_broker(address);
  end_without_farewell(router, tick_endpoint);
  router.close();
  ASSERT_EQ(broker.wait_for(std::chrono::seconds(30)), std::future_status::ready);
  EXPECT_EQ(broker.get().exit_code, 0);
}

}  // namespace
}  // namespace dmise
