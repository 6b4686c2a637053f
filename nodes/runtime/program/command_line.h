#pragma once
#include <CLI/CLI.hpp>
#include <string>

namespace dmise {

/// Empty for an address that a socket takes: tcp://HOST:PORT (PORT 0 to 65535, or *), ipc:// or
/// inproc://. Else why not, with the address that is likely meant.
std::string complaint_of_address(const std::string& address);

/// Lets an option take only such addresses.
CLI::Validator transport_address();

/// What to say of the first argument that nobody takes: "unknown option --thread, did you mean
/// --threads?". Empty when there is none.
std::string unknown_argument(const CLI::App& app);

/// Says what is wrong with a command line, or prints the help that was asked for. Returns the exit
/// code of the program: 0 or 2.
int end_of_command_line(const CLI::App& app, const CLI::ParseError& error);

}  // namespace dmise
