// A node for tests that need processes of their own: orbit, a camera, or the recorder. Says each
// tick on stdout and may hang in one.
#include <poll.h>

#include <cstdio>

#include "nodes/runtime/node/node.h"
#include "nodes/runtime/program/program.h"
#include "tests/runtime/toy.h"

namespace {

/// Says each step of another participant, and hangs in one of them if asked to.
class Telling : public dmise::Participant {
 public:
  Telling(dmise::Participant& participant, dmise::Tick hang_at)
      : participant_(participant), hang_at_(hang_at) {}
  std::string name() const override { return participant_.name(); }
  std::vector<std::string> produces() const override { return participant_.produces(); }
  std::vector<std::string> consumes() const override { return participant_.consumes(); }
  bool needs(const std::string& topic) const override { return participant_.needs(topic); }
  std::vector<dmise::Message> step(dmise::Tick tick,
                                   std::span<const dmise::Message> inputs) override {
    std::printf("step %ld\n", long(tick));
    std::fflush(stdout);
    if (tick == hang_at_)
      for (;;) poll(nullptr, 0, -1);
    return participant_.step(tick, inputs);
  }
  std::vector<dmise::Message> resume(dmise::Tick tick,
                                     std::span<const dmise::Message> past) override {
    return participant_.resume(tick, past);
  }

 private:
  dmise::Participant& participant_;
  dmise::Tick hang_at_;
};

}  // namespace

int main(int argc, char** argv) {
  dmise::CommonFlags flags;
  std::string role;
  dmise::Tick hang_at = -1;
  CLI::App app("A node for tests.", "toy-node");
  dmise::add_common_flags(app, flags);
  app.add_option("--role", role, "orbit, camera or recorder")->required();
  app.add_option("--hang-at", hang_at, "tick whose step never ends");
  return dmise::run_program(app, flags, argc, argv, [&] {
    dmise::test::ToyOrbit orbit;
    dmise::test::ToyCamera camera(flags.name);
    dmise::test::ToyRecorder recorder({"a", "b"}, false);
    dmise::Participant& participant = role == "orbit"    ? static_cast<dmise::Participant&>(orbit)
                                      : role == "camera" ? static_cast<dmise::Participant&>(camera)
                                                         : recorder;
    Telling telling(participant, hang_at);
    return dmise::run_node(telling, {.master = flags.master,
                                     .host = flags.host,
                                     .stop_within_s = 0.7,
                                     .keys = flags.keys,
                                     .via = flags.via,
                                     .stop = &dmise::stop_signal()})
        .exit_code;
  });
}
