#include "launch/process/view_process.h"

#include <fcntl.h>
#include <unistd.h>

#include <filesystem>
#include <random>

#include "core/base/error.h"
#include "core/base/files/text_file.h"
#include "core/base/formatted.h"
#include "launch/process/supervisor.h"

namespace dmise {
namespace {

/// 32 hexadecimal digits from the kernel's random numbers.
std::string random_token() {
  std::random_device random;
  return formatted("%08x%08x%08x%08x", random(), random(), random(), random());
}

}  // namespace

std::vector<std::string> gateway_command(const ViewOptions& options) {
  std::vector<std::string> command{program_directory() + "/dmise-gateway", "--master",
                                   options.master, "--listen", options.listen};
  const auto add = [&](const char* option, const std::string& value) {
    if (!value.empty()) command.insert(command.end(), {option, value});
  };
  add("--products", options.products);
  add("--keys", options.keys);
  add("--tokens", options.tokens);
  add("--announce", options.announce);
  add("--answer-within", shortest_text(options.answer_within_s));
  if (options.no_control) command.push_back("--no-control");
  if (options.truth) command.push_back("--truth");
  return command;
}

std::string make_view_tokens(const std::string& path) {
  unlink(path.c_str());
  const std::string control = random_token();
  const std::string text = "view " + random_token() + "\noperator " + control + "\n";
  const int file = open(path.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0600);
  const bool written = file >= 0 && write(file, text.data(), text.size()) == ssize_t(text.size());
  if (file >= 0) close(file);
  if (!written) throw Error(path + ": cannot be written");
  return control;
}

std::optional<std::string> announced_url(const std::string& path) {
  if (!std::filesystem::exists(path)) return std::nullopt;
  std::string url = read_text_file(path, 4096);
  while (!url.empty() && url.back() == '\n') url.pop_back();
  return url;
}

}  // namespace dmise
