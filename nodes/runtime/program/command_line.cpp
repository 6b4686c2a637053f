#include "nodes/runtime/program/command_line.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <vector>

#include "core/base/nearest_name.h"
#include "core/base/printable.h"
#include "nodes/runtime/process/host_port.h"

namespace dmise {
namespace {

constexpr std::string_view tcp = "tcp://";

bool is_port(std::string_view text) {
  std::uint16_t port = 0;
  const char* const end = text.data() + text.size();
  return text == "*" ||
         std::from_chars(text.data(), end, port) == std::from_chars_result{end, std::errc{}};
}

/// HOST:PORT, [IPv6]:PORT.
bool is_host_and_port(std::string_view text) {
  const auto parts = split_host_and_port(text);
  return parts && is_port(parts->second);
}

/// Splits off "SCHEME:" and slashes.
std::string_view without_scheme(std::string_view text) {
  const auto slashes = text.find("//");
  if (slashes != text.npos) return text.substr(slashes + 2);
  for (const std::string_view scheme : {"tcp:/", "tcp:"})
    if (text.starts_with(scheme)) return text.substr(scheme.size());
  return text;
}

std::vector<const CLI::App*> chain_of(const CLI::App& app) {
  std::vector<const CLI::App*> chain{&app};
  while (true) {
    const auto parsed =
        chain.back()->get_subcommands([](const CLI::App* sub) { return sub->parsed(); });
    if (parsed.empty()) return chain;
    chain.push_back(parsed.back());
  }
}

std::vector<std::string> options_of(const std::vector<const CLI::App*>& chain) {
  std::vector<std::string> names;
  for (const CLI::App* app : chain)
    for (const CLI::Option* option : app->get_options())
      for (const auto& name : option->get_lnames()) names.push_back("--" + name);
  return names;
}

/// Describes the first unknown argument: "unknown option --thread, did you mean --threads?". Empty
/// if there is none.
std::string unknown_argument(const CLI::App& app) {
  const auto chain = chain_of(app);
  for (auto at = chain.rbegin(); at != chain.rend(); ++at) {
    // The value of an unknown option is not an argument itself.
    const auto left = (*at)->remaining(false);
    const auto flag = std::find_if(left.begin(), left.end(),
                                   [](const std::string& word) { return word.starts_with('-'); });
    if (left.empty()) continue;
    const bool option = flag != left.end();
    const std::string word = option ? flag->substr(0, flag->find('=')) : left.front();
    std::vector<std::string> known = options_of(chain);
    if (!option) {
      known.clear();
      for (const CLI::App* sub :
           chain.back()->get_subcommands([](const CLI::App*) { return true; }))
        known.push_back(sub->get_name());
      if (known.empty()) return "unexpected argument " + word;
    }
    return (option ? "unknown option " : "unknown command ") + word + did_you_mean(word, known);
  }
  return "";
}

}  // namespace

std::string address_error(const std::string& address) {
  for (const std::string_view local : {"ipc://", "inproc://"})
    if (address.starts_with(local) && address.size() > local.size()) return "";
  // tcp://INTERFACE;HOST:PORT is ZeroMQ's too.
  const std::string_view text = address;
  if (text.starts_with(tcp) && is_host_and_port(text.substr(tcp.size()))) return "";
  std::string complaint = "must be tcp://HOST:PORT";
  if (const auto rest = without_scheme(text); is_host_and_port(rest))
    complaint += ", did you mean " + std::string(tcp) + std::string(rest) + "?";
  return complaint + ", got " + address;
}

CLI::Validator transport_address() {
  return {[](std::string& address) { return address_error(address); }, "", "address"};
}

CLI::Validator one_of(std::vector<std::string> words) {
  std::string described;
  for (const std::string& word : words) described += (described.empty() ? "" : "|") + word;
  return {[words](std::string& text) -> std::string {
            if (std::ranges::find(words, text) != words.end()) return "";
            return "must be one of " + joined(words, ", ") + did_you_mean(text, words) + ", got " +
                   text;
          },
          described, "word"};
}

CLI::Validator number_between(double low, double high) {
  const CLI::Range range(low, high);
  return {[range](std::string& text) {
            double value = 0.0;
            if (CLI::detail::lexical_cast(text, value) && std::isnan(value))
              return "Value " + text + " is no number";
            return range(text);
          },
          range.get_description(), "number"};
}

void want_decimal_numbers(CLI::App& command) {
  const auto why_not = [](const std::string& text) -> std::string {
    std::string_view digits = text;
    if (digits.starts_with('-') || digits.starts_with('+')) digits.remove_prefix(1);
    const bool other_base = digits.size() > 1 && digits.front() == '0';
    return other_base ? "Value " + text + " is no decimal number: it begins with 0" : "";
  };
  for (CLI::Option* option : command.get_options())
    if (const std::string type = option->get_type_name();
        type.starts_with("INT") || type.starts_with("UINT"))
      option->transform(CLI::Validator([why_not](std::string& text) { return why_not(text); }, ""));
  for (CLI::App* part : command.get_subcommands([](CLI::App*) { return true; }))
    want_decimal_numbers(*part);
}

int end_of_command_line(const CLI::App& app, const CLI::ParseError& error) {
  if (error.get_exit_code() == 0) return app.exit(error);
  std::string command;
  for (const CLI::App* part : chain_of(app))
    command += (command.empty() ? "" : " ") + part->get_name();
  std::string unknown = unknown_argument(app);
  // An unknown argument explains more than a missing one.
  const std::string reason = unknown.empty() ? error.what() : unknown;
  std::fprintf(stderr, "%s: %s (%s --help)\n", command.c_str(), reason.c_str(), command.c_str());
  return 2;
}

}  // namespace dmise
