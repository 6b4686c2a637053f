#pragma once
#include <map>
#include <set>
#include <string>
#include <vector>

namespace dmise {

/// What a process may connect to. A public key without `truth` is refused where truth is served;
/// without keys, whoever has not joined is refused at `run`, the broker's endpoints for nodes.
enum class Domain { control, data, run, truth };

/// A CURVE key pair, each in Z85 (ZeroMQ RFC 32): 40 characters.
struct KeyPair {
  std::string public_key;
  std::string secret_key;  // empty: only the public half is known
};

/// One who may take part: NAME.pub in the directory of keys.
struct AllowedKey {
  std::string name;
  std::string public_key;
  bool truth = false;
  std::set<std::string> nodes;  // of the agent of a host: those for whom it may speak
};

/// Makes NAME.key (mode 0600: both keys) and NAME.pub (public key, and what is granted: "truth",
/// `nodes` for whom an agent may speak) in `directory`, which is made with mode 0700 if it is not
/// there. Throws `ConfigError` when there is such a key already, or when nobody speaks for one of
/// `nodes`; `Error` when it can't be written.
void make_key(const std::string& directory, const std::string& name, bool truth,
              const std::set<std::string>& nodes = {});

// Rings are many keys in one file, for those who are given files and no directory (containers): in
// a directory of keys, X.keys counts as the NAME.key and X.pubs as the NAME.pub of each "name NAME"
// in it.

/// Makes rings/RING.keys (mode 0600) of the pairs of the names of each of `rings`, and
/// rings/everybody.pubs of all NAME.pub. Throws as `make_key`, and as `read_key`.
void make_rings(const std::string& directory,
                const std::map<std::string, std::vector<std::string>>& rings);

/// Reads NAME.key. Throws `ConfigError` when it is not there, is none, or others may read it.
KeyPair read_key(const std::string& directory, const std::string& name);

/// All NAME.pub of a directory, by public key. A file that is none is left out: its owner is
/// refused. `left_out`: where to say why, if anywhere.
std::map<std::string, AllowedKey> read_allowed(const std::string& directory,
                                               std::vector<std::string>* left_out = nullptr);

/// Throws `ConfigError` with file and reason for the first NAME.pub, or ring, that is none: not
/// whole, not a regular file, or not to be read. Waits for nobody.
void check_keys(const std::string& directory);

/// The public key of `name`. Throws `ConfigError` when there is none.
std::string public_key_of(const std::string& directory, const std::string& name);

/// Whether only processes of this machine reach an address: "tcp://127.x.y.z:PORT",
/// "tcp://[::1]:PORT", "tcp://localhost:PORT", "ipc://", "inproc://".
bool is_loopback(const std::string& address);

}  // namespace dmise
