#pragma once
#include <string>
#include <vector>

#include "core/base/sim_time.h"
#include "core/config/yaml/section.h"

namespace dmise {

class YamlValue;
class JsonWriter;

/// What a program of the user's does: it is a node of the run, or runs in the process of a sensor
/// or of the fusion node.
enum class OwnNodeRole { none, actor, detector, tracker, sensor };

/// Topics that a node hears: `detection/alpha`, or `detection/*` of all sensors.
struct HeardTopics {
  std::string pattern;
  std::string where;  // `file:line:column: nodes[0].consumes[0]`
};

/// A program of the user's: `{name: gnc, run: [python3, gnc.py]}`.
struct OwnNode {
  std::string name;
  std::string where;             // `file:line:column: nodes[0]`, for messages
  std::vector<std::string> run;  // program and arguments; empty: somebody joins it
  std::string run_where;         // `file:line:column: nodes[0].run`
  std::string directory;         // in which it runs: that of the scenario
  bool is_function = false;      // a function of this process, which speaks for it
  Tick period_ticks = 1;         // between those that it is asked for
  std::string options_json = "{}";
  bool is_fmu = false;                   // which moves or turns one object
  std::vector<std::string> fmu_outputs;  // that its table has: "position_m"
  std::string fmu_outputs_where;         // `file:line:column: nodes[0].outputs`
  std::vector<HeardTopics> hears;
  std::vector<std::string> consumes;  // the topics of the scenario that these are, sorted
  Tick delay_ticks = 1;               // after which it hears them
  OwnNodeRole role = OwnNodeRole::none;
};

/// The keys of a node, for lists of them.
Forms own_nodes_forms();
/// What speaks for the models of a scenario's nodes: their programs, or functions of this process.
enum class OwnNodeModels { programs, functions };

/// Reads `nodes:`; what they run is ignored if functions speak for them. Throws `ConfigError`
/// `file:line:column: key: reason`.
std::vector<OwnNode> read_own_nodes(const YamlValue& value, OwnNodeModels models);

/// Writes the part that determines the products, without the content of files.
void write_own_nodes(JsonWriter& json, const std::vector<OwnNode>& nodes);
/// The program and those of its arguments that are files.
std::vector<std::string> files_of(const std::vector<OwnNode>& nodes);
/// Path of the program, found as a shell in the node's directory would. Empty if there is none.
std::string program_of(const OwnNode& node);

/// "python3 gnc.py", for messages.
std::string command_text(const OwnNode& node);
/// Throws `ConfigError` that lists the programs that these nodes would start, if there are any, but
/// for those in directories that the user trusts (core/config/yaml/trusted_directories.h).
void refuse_programs(const std::vector<OwnNode>& nodes);
/// Throws `ConfigError` if there are nodes; `who` can't have any: "dmise tradeoff".
void refuse_own_nodes(const std::vector<OwnNode>& nodes, const std::string& who);

}  // namespace dmise
