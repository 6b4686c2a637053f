// The lock-step protocol under any order of events: processes that work as they should, die, hang,
// are started again; a clock that is paused, stepped and paced. No tick is done twice once all
// have done it, none is lost, and while lost nodes come back the run reaches its end with the
// digest of an undisturbed one.
#include <array>

#include "core/base/files/fold_digest.h"
#include "tests/fuzz/chunks.h"
#include "time-master/coordinator.h"

namespace {

using namespace dmise;
using std::chrono::milliseconds;

constexpr Tick last_tick = 12;

void must(bool holds) {
  if (!holds) __builtin_trap();
}

struct Role {
  NodeTopics node;
  bool keeps_time = true;
};

const std::array<Role, 4>& roles() {
  static const std::array<Role, 4> all{{{{"broker", {}, {}, 0, {}}, false},
                                        {{"orbit", {"state"}, {}, 0, {}}, true},
                                        {{"camera", {"image"}, {"state"}, 2, {2, 1}}, true},
                                        {{"tracker", {}, {"image"}, 0, {}}, true}}};
  return all;
}

/// What a node says of a tick: a function of the tick alone, as its products are.
TickTally tally_of(const Role& role, Tick tick) {
  TickTally tally{tick, {}, 0};
  for (const std::string& topic : role.node.produces)
    tally.topics.push_back(
        {topic, 1, std::uint64_t(tick) + 1, fold_digest(topic.size(), std::uint64_t(tick))});
  return tally;
}

struct World {
  struct Process {
    bool alive = false;
    bool ready = false;
    Tick next = 0;                          // to do
    std::array<bool, last_tick + 1> did{};  // whatever the incarnation
  };

  World(SilentPolicy policy, int window) {
    CoordinatorOptions o;
    for (const Role& role : roles()) o.expected.push_back(role.node.name);
    o.last_tick = last_tick;
    o.window_ticks = window;
    o.on_silent = policy;
    master.emplace(o);
  }

  void start(std::size_t i) {
    Process& process = processes[i];
    const Tick settled = master->settled();
    if (process.alive ||
        master->join({.node = roles()[i].node, .keeps_time = roles()[i].keeps_time}, now))
      return;
    const auto& member = master->members().at(roles()[i].node.name);
    must(member.resumes_at == settled + 1);  // what all have done is not done again
    process.alive = true;
    process.ready = !roles()[i].keeps_time;
    process.next = roles()[i].node.schedule.next_after(member.resumes_at - 1);
  }

  void get_ready(std::size_t i) {
    if (!processes[i].alive || processes[i].ready || master->phase() == Phase::gathering) return;
    processes[i].ready = true;
    master->ready(roles()[i].node.name, now);
  }

  /// One tick, if it is granted and what it needs has been said.
  void work(std::size_t i) {
    Process& process = processes[i];
    const Role& role = roles()[i];
    if (!process.alive || !process.ready || !role.keeps_time || master->phase() != Phase::running ||
        process.next > master->granted() || process.next > last_tick)
      return;
    for (std::size_t j = 0; j < roles().size(); ++j)
      for (const std::string& topic : role.node.consumes)
        for (const std::string& produced : roles()[j].node.produces)
          if (topic == produced && !covers(j, process.next)) return;
    const auto member = master->members().find(role.node.name);
    if (member == master->members().end() || member->second.dropped) return;
    master->done(role.node.name, tally_of(role, process.next), now);
    must(master->phase() != Phase::failed);
    process.did[std::size_t(process.next)] = true;
    process.next = role.node.schedule.next_after(process.next);
  }

  bool covers(std::size_t producer, Tick tick) const {
    const auto member = master->members().find(roles()[producer].node.name);
    if (member != master->members().end() && member->second.dropped &&
        tick >= member->second.closed_from)
      return true;
    return processes[producer].next > tick;
  }

  void pass(milliseconds time) {
    const Instant until = now + time;
    while (now < until) {
      now += std::min<Instant>(milliseconds(2000), until - now);
      for (std::size_t i = 0; i < roles().size(); ++i)
        if (processes[i].alive)
          master->heartbeat(roles()[i].node.name, false, std::uint64_t(processes[i].next), now);
      master->check(now);
    }
  }

  void look() {
    must(master->granted() >= granted && master->settled() >= settled);
    must(master->settled() <= master->granted() && master->granted() <= last_tick);
    granted = master->granted();
    settled = master->settled();
    for (std::size_t i = 0; i < roles().size(); ++i) {  // none is lost
      const Role& role = roles()[i];
      const auto member = master->members().find(role.node.name);
      if (!role.keeps_time || member == master->members().end() || !member->second.active())
        continue;
      for (Tick tick = role.node.schedule.next_after(-1); tick <= settled;
           tick = role.node.schedule.next_after(tick))
        must(processes[i].did[std::size_t(tick)]);
    }
  }

  void happen(std::uint8_t event) {
    const std::size_t i = event & 3;
    const std::string& name = roles()[i].node.name;
    switch (event >> 2 & 15) {
      case 0:
      case 1:
      case 2:
      case 3:
      case 4:
      case 5:
        return work(i);
      case 6:
      case 7:
        return start(i);
      case 8:
        return get_ready(i);
      case 9:  // killed: its connection breaks
        if (processes[i].alive) master->suspect(name, now);
        processes[i].alive = false;
        return;
      case 10:  // cut off
        processes[i].alive = false;
        return;
      case 11:
        return pass(milliseconds(event & 64 ? 6000 : 900));
      case 12:
        return event & 64 ? master->pause() : master->step(1, now);
      case 13:
        return event & 64 ? master->go_on(now) : master->change_pace(event & 1 ? 2.0 : 0.0, now);
      case 14:
        if (event & 64 &&
            !master->join({.node = {"watcher", {}, {"image"}, 0, {}}, .observer = true}, now))
          return;
        return master->leave("watcher", true, now);
      default:
        return pass(milliseconds(100));
    }
  }

  /// Whoever is lost is started again, everybody works: the run must end.
  void bring_to_end() {
    master->go_on(now);
    master->change_pace(0.0, now);
    for (int round = 0; round < 30 && !master->over(); ++round) {
      pass(milliseconds(6000));
      for (std::size_t i = 0; i < roles().size(); ++i) {
        start(i);
        get_ready(i);
      }
      for (Tick tick = 0; tick <= last_tick; ++tick)
        for (std::size_t i = 0; i < roles().size(); ++i) work(i);
      look();
    }
    must(master->phase() == Phase::ended);
    must(master->settled() == last_tick);
  }

  std::optional<Coordinator> master;
  std::array<Process, 4> processes;
  Instant now{0};
  Tick granted = -1, settled = -1;
};

std::uint64_t undisturbed_digest() {
  World world(SilentPolicy::wait, 1);
  world.bring_to_end();
  return world.master->digest();
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const std::uint64_t digest = undisturbed_digest();
  if (size == 0) return 0;
  World world(SilentPolicy(data[0] % 3), 1 + data[0] / 4 % 4);
  for (std::size_t i = 1; i < std::min<std::size_t>(size, 96); ++i) {
    world.happen(data[i]);
    world.look();
  }
  if (data[0] % 3 != int(SilentPolicy::wait)) return 0;
  world.bring_to_end();
  must(world.master->digest() == digest);
  return 0;
}
