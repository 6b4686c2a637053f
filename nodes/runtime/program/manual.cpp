#include "nodes/runtime/program/manual.h"

#include <algorithm>
#include <cctype>

namespace dmise {
namespace {

/// Text of one paragraph, safe for roff.
std::string escaped(std::string_view text) {
  std::string out;
  for (const char c : text) {
    if (out.empty() && (c == '.' || c == '\'')) out += "\\&";
    if (c == '\n') {
      out += "\n.br\n";
    } else if (c == '\\') {
      out += "\\e";
    } else {
      out += c == '-' ? "\\-" : std::string(1, c);
    }
  }
  return out;
}

std::string bold(std::string_view text) { return "\\fB" + escaped(text) + "\\fR"; }

/// "dmise run" of the page dmise-run: the words of a command line.
std::string command_of(const CLI::App& app) {
  const CLI::App* parent = app.get_parent();
  return (parent ? command_of(*parent) + " " : "") + app.get_name();
}

std::string first_sentence(const std::string& text) {
  const std::size_t end = std::min(text.find(". "), text.find('\n'));
  std::string first = text.substr(0, end);
  if (first.ends_with('.')) first.pop_back();
  return first;
}

void write_options(const CLI::App& app, std::string& page) {
  for (const CLI::Option* option : shown_options(app)) {
    const bool takes_value = option->get_items_expected_max() > 0;
    page += ".TP\n" + bold(option->get_name(option->get_positional(), true));
    if (takes_value && !option->get_positional()) page += " " + escaped(option->get_type_name());
    page += "\n" + escaped(option->get_description());
    if (option->get_required()) page += " (needed)";
    if (takes_value && !option->get_default_str().empty())
      page += " (" + escaped(option->get_default_str()) + ")";
    page += '\n';
  }
}

/// A command within a command, such as `list cameras`.
void write_command(const CLI::App& app, std::string& page) {
  page += ".TP\n" + bold(app.get_name()) + "\n" + escaped(app.get_description()) + "\n";
  if (shown_options(app).size() <= 1 && shown_commands(app).empty()) return;  // only --help
  page += ".RS\n";
  write_options(app, page);
  for (const CLI::App* command : shown_commands(app)) write_command(*command, page);
  page += ".RE\n";
}

}  // namespace

std::vector<const CLI::App*> shown_commands(const CLI::App& app) {
  return app.get_subcommands([](const CLI::App* sub) { return !sub->get_group().empty(); });
}

std::vector<const CLI::Option*> shown_options(const CLI::App& app) {
  return app.get_options([](const CLI::Option* option) { return !option->get_group().empty(); });
}

std::string manual_page(const CLI::App& app, const std::string& name, const std::string& version,
                        const std::vector<std::string>& see_also) {
  const std::string command = command_of(app);
  std::string upper = name;
  std::transform(upper.begin(), upper.end(), upper.begin(),
                 [](unsigned char c) { return char(std::toupper(c)); });
  std::string page = ".TH \"" + upper + "\" 1 \"\" \"" + version + "\" \"DMISE\"\n.ad l\n";
  page += ".SH NAME\n" + escaped(name) + " \\- " + escaped(first_sentence(app.get_description())) +
          "\n";
  page += ".SH SYNOPSIS\n" + bold(command);
  const auto options = shown_options(app);
  if (std::any_of(options.begin(), options.end(),
                  [](const CLI::Option* option) { return !option->get_positional(); }))
    page += " [options]";
  for (const CLI::Option* option : options) {
    if (!option->get_positional()) continue;
    const std::string word = option->get_name(true, false);
    page += escaped(option->get_required() ? " " + word : " [" + word + "]");
    if (option->get_items_expected_max() > 1) page += " ..";
  }
  const auto commands = shown_commands(app);
  if (!commands.empty()) page += " command ..";
  page += "\n.SH DESCRIPTION\n" + escaped(app.get_description()) + "\n.SH OPTIONS\n";
  write_options(app, page);
  if (!commands.empty()) page += ".SH COMMANDS\n";
  for (const CLI::App* sub : commands) {
    if (app.get_parent()) {
      write_command(*sub, page);
    } else {
      page += ".TP\n" + bold(sub->get_name()) + "\n" + escaped(sub->get_description()) + "\n";
    }
  }
  page += ".SH EXIT STATUS\n0: success. 1: failure. 2: a wrong command line or file.\n";
  if (!see_also.empty()) page += ".SH SEE ALSO\n";
  for (const auto& other : see_also)
    page += bold(other) + (&other == &see_also.back() ? "(1)\n" : "(1), ");
  return page;
}

}  // namespace dmise
