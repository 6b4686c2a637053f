#include "bench/network_run.h"

#include <fcntl.h>
#include <signal.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <sstream>
#include <thread>

#include "bench/catalogue_file.h"
#include "core/base/error.h"

namespace dmise {
namespace {

namespace fs = std::filesystem;
using Clock = std::chrono::steady_clock;

constexpr auto look_interval = std::chrono::milliseconds(1700);  // not a divisor of a tick
constexpr double tick_s = 5.0;
constexpr int shutters = 4;  // number of start times, one tick apart

std::string text_of(const fs::path& path) {
  std::ifstream file(path);
  std::ostringstream text;
  text << file.rdbuf();
  return std::move(text).str();
}

double number_in(const std::string& json, const std::string& key) {
  const auto at = json.find("\"" + key + "\":");
  return at == std::string::npos ? 0.0 : std::strtod(json.c_str() + at + key.size() + 3, nullptr);
}

/// Starts `dmise launch` with its output in `log`; it ends with this process.
pid_t launch(const fs::path& scenario, const fs::path& out, const fs::path& log) {
  const pid_t parent = getpid();
  const pid_t pid = fork();
  if (pid < 0) throw Error("network: can't start a process");
  if (pid > 0) return pid;
  prctl(PR_SET_PDEATHSIG, SIGTERM);
  if (getppid() != parent) _exit(1);
  const int fd = open(log.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0644);
  dup2(fd, STDOUT_FILENO);
  dup2(fd, STDERR_FILENO);
  const std::string program = fs::read_symlink("/proc/self/exe").parent_path() / "dmise";
  execl(program.c_str(), program.c_str(), "launch", scenario.c_str(), "--out", out.c_str(),
        "--force", nullptr);
  _exit(127);
}

/// Removes images that are complete.
void remove_frames(const fs::path& out) {
  const auto old = fs::file_time_type::clock::now() - std::chrono::seconds(4);
  std::error_code ignored;
  for (const auto& sensor : fs::directory_iterator(out, ignored))
    for (const auto& file : fs::directory_iterator(sensor.path(), ignored))
      if (file.path().extension() == ".fits" && file.last_write_time(ignored) < old)
        fs::remove(file.path(), ignored);
}

int frames_made(const fs::path& out) {
  int frames = 0;
  std::error_code ignored;
  for (const auto& sensor : fs::directory_iterator(out, ignored)) {
    if (!sensor.is_directory(ignored)) continue;
    const std::string lines = text_of(sensor.path() / "frames.jsonl");
    frames += int(std::count(lines.begin(), lines.end(), '\n'));
  }
  return frames;
}

bool is_sensor(const ProcessUse& process) { return process.name.starts_with("all-sky-"); }

std::map<std::string, double> cpu_by_program_s(const ProcessFamily& family) {
  std::map<std::string, double> cpu_s;
  for (const ProcessUse& member : family.members())
    cpu_s[is_sensor(member) ? "sensors" : member.name] += member.cpu_s;
  return cpu_s;
}

double cpu_s(const rusage& use) {
  return double(use.ru_utime.tv_sec + use.ru_stime.tv_sec) +
         1e-6 * double(use.ru_utime.tv_usec + use.ru_stime.tv_usec);
}

std::string last_line_of(const std::string& text) {
  std::istringstream lines(text);
  std::string line, last;
  while (std::getline(lines, line))
    if (!line.empty()) last = line;
  return last;
}

}  // namespace

std::string network_scenario(const NetworkCase& network, const fs::path& directory) {
  const WrittenCatalogue catalogue = catalogue_of_18470(directory);
  std::ostringstream text;
  const double duration_s = network_cadence_s * network.frames + tick_s * (shutters - 1);
  text << "simulation: {start: " << catalogue.start_utc << ", duration_s: " << duration_s
       << ", tick_s: " << tick_s << "}\nobjects: [{catalogue: " << catalogue.path
       << "}]\nstars: {catalogue: kstars, faintest_mag: 9}\ndetection: "
       << (network.detect ? "on" : "off") << "\nsensors:\n";
  for (int i = 0; i < network.sensors; ++i)
    text << "  - {name: all-sky-" << i + 1 << ", site: {latitude_deg: " << 26.0 + 1.8 * (i % 10)
         << ", longitude_deg: " << -90.0 + 2.0 * (i / 10 % 10)
         << ", height_m: 200}, camera: omnissa, pointing: zenith, exposure_s: 20, cadence_s: 20, "
            "first_exposure_s: "
         << tick_s * (i % shutters) << ", sky: dark}\n";
  text << "network: {real_time: " << network.real_time
       << ", join_within_s: 600, silent_after_s: 60}\n"
          "output: {fits: true, png: false, truth: true}\n";
  return std::move(text).str();
}

NetworkRun run_network(const NetworkCase& network, const fs::path& directory) {
  fs::create_directories(directory);
  const fs::path scenario = directory / "network.yaml", out = directory / "run",
                 log = directory / "launch.log";
  std::ofstream(scenario) << network_scenario(network, directory);
  NetworkRun run;
  const auto started = Clock::now();
  auto ready = started;
  double cpu_before_s = -1.0;
  const pid_t launcher = launch(scenario, out, log);
  ProcessFamily family(launcher);
  int status = 0;
  rusage use{};
  auto next_look = started;
  while (wait4(launcher, &status, WNOHANG, &use) == 0) {
    const bool begins =
        cpu_before_s < 0.0 &&
        text_of(out / "logs/time-master.log").find("all are ready") != std::string::npos;
    if (begins || Clock::now() >= next_look) {
      next_look = Clock::now() + look_interval;
      family.update();
      remove_frames(out);
    }
    if (begins) {
      ready = Clock::now();
      cpu_before_s = family.cpu_s();
      run.cpu_of_s = cpu_by_program_s(family);
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
  }
  const auto seconds = [](auto span) { return std::chrono::duration<double>(span).count(); };
  run.start_s = seconds(ready - started);
  run.wall_s = seconds(Clock::now() - ready);
  run.cpu_s = cpu_s(use) - std::max(0.0, cpu_before_s);
  for (const auto& [program, seconds_in_all] : cpu_by_program_s(family))
    run.cpu_of_s[program] = seconds_in_all - run.cpu_of_s[program];
  run.frames = frames_made(out);
  run.complete = WIFEXITED(status) && WEXITSTATUS(status) == 0;
  if (!run.complete) run.reason = last_line_of(text_of(log));
  const std::string report = text_of(out / "logs/master.json");
  run.overruns = long(number_in(report, "overruns"));
  run.worst_lag_s = number_in(report, "worst_lag_s");
  run.peak_pss_mb = family.peak_pss_mb();
  for (const ProcessUse& member : family.members()) {
    if (!is_sensor(member)) continue;
    run.sensor_pss_mb = std::max(run.sensor_pss_mb, member.peak_pss_mb);
    run.sensor_most_mb = std::max(run.sensor_most_mb, member.max_pss_mb);
  }
  fs::remove_all(out);
  return run;
}

}  // namespace dmise
