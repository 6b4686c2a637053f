#pragma once
#include <CLI/CLI.hpp>
#include <string>
#include <vector>

namespace dmise {

/// Returns why a socket does not accept an address, with a suggestion; empty for tcp://HOST:PORT
/// (PORT 0 to 65535, or *), ipc:// and inproc://.
std::string address_error(const std::string& address);

/// Restricts an option to such addresses.
CLI::Validator transport_address();

/// Restricts an option to these words, with a suggestion for one that is misspelt.
CLI::Validator one_of(std::vector<std::string> words);

/// Restricts an option to numbers from `low` to `high`; unlike CLI::Range it refuses NaN.
CLI::Validator number_between(double low, double high);

/// Restricts all options of a command and its subcommands that are whole numbers to decimal ones:
/// else 010 would be 8, and 0x10 would be 16.
void want_decimal_numbers(CLI::App& command);

/// Prints what is wrong with a command line, or the requested help. Returns the exit code of the
/// program: 0 or 2.
int end_of_command_line(const CLI::App& app, const CLI::ParseError& error);

}  // namespace dmise
