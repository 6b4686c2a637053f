#include "launch/view_process.h"

#include <sys/stat.h>

#include <filesystem>
#include <fstream>

#include "core/base/error.h"
#include "core/base/text_file.h"
#include "launch/lock_holder.h"
#include "launch/supervisor.h"

namespace dmise {
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
  if (options.no_control) command.push_back("--no-control");
  if (options.truth) command.push_back("--truth");
  return command;
}

std::string make_view_tokens(const std::string& path) {
  std::error_code ignored;
  std::filesystem::remove(path, ignored);
  const mode_t before = umask(077);
  std::ofstream file(path);
  umask(before);
  const std::string control = random_token();
  file << "view " << random_token() << "\noperator " << control << "\n";
  if (!file.flush()) throw Error(path + ": cannot be written");
  return control;
}

std::optional<std::string> announced_url(const std::string& path) {
  if (!std::filesystem::exists(path)) return std::nullopt;
  std::string url = read_text_file(path, 4096);
  while (!url.empty() && url.back() == '\n') url.pop_back();
  return url;
}

}  // namespace dmise
