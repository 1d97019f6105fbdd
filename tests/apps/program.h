// Runs the program as a user does: in a child process, in a folder of its own.
#pragma once

#include <fcntl.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <initializer_list>
#include <iterator>
#include <nlohmann/json.hpp>
#include <set>
#include <sstream>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

extern char** environ;

namespace softland {

namespace fs = std::filesystem;

inline std::string read(const fs::path& path) {
  std::ifstream in(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}
inline void write(const fs::path& path, const std::string& text) { std::ofstream(path, std::ios::binary) << text; }
inline std::string shipped(const std::string& name) { return read(fs::path(SOFTLAND_SOURCE_DIR) / "scenes" / name); }

/// Returns `text` with the first `from` replaced by `to`.
inline std::string edited(std::string text, const std::string& from, const std::string& to) {
  const std::size_t at = text.find(from);
  if (at == std::string::npos) throw std::logic_error("no '" + from + "' in the test's text");
  return text.replace(at, from.size(), to);
}

struct Outcome {
  int status = -1;  ///< exit status, or minus the number of the signal that ended the program
  std::string out, err;
};

/// The state of a process, from /proc/PID/stat (proc(5)).
struct ProcessState {
  char state = 'X';     ///< R: runs or is ready to run, S: sleeps, Z: has ended, X: no such process
  long cpu_ticks = -1;  ///< processor time used so far by all threads; -1 if unknown
};
inline ProcessState process_state(pid_t child) {
  const std::string stat = read("/proc/" + std::to_string(child) + "/stat");
  const std::size_t name_end = stat.rfind(')');  // the name of the program before it may contain any character
  if (name_end == std::string::npos) return {};
  std::istringstream fields(stat.substr(name_end + 1));
  ProcessState process;
  long user = 0, system = 0;
  std::string skipped;
  fields >> process.state;
  for (int field = 4; field < 14; ++field) fields >> skipped;
  fields >> user >> system;
  process.cpu_ticks = user + system;
  return process;
}

/// Waits until the process has used some processor time, even on a busy machine; at most a minute.
inline void wait_until_it_computes(pid_t child) {
  const long enough = sysconf(_SC_CLK_TCK) / 2;
  for (int i = 0; i < 1200; ++i) {
    const ProcessState process = process_state(child);
    if (process.cpu_ticks >= enough || process.state == 'Z' || process.state == 'X') return;
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
  }
}

/// Waits until the process sleeps; at most a minute.
inline void wait_until_it_waits(pid_t child) {
  long ticks = -1;
  for (int i = 0, quiet = 0; i < 1200 && quiet < 10; ++i) {
    const ProcessState process = process_state(child);
    if (process.state == 'Z' || process.state == 'X') return;
    quiet = process.state == 'S' && process.cpu_ticks == ticks ? quiet + 1 : 0;
    ticks = process.cpu_ticks;
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
  }
}

/// A temporary folder in which the program runs.
class Workplace {
 public:
  Workplace() {
    std::string name = (fs::temp_directory_path() / "softland-test-XXXXXX").string();
    if (mkdtemp(name.data()) == nullptr) throw std::runtime_error("no temporary folder");
    path_ = fs::canonical(name);
    write(path_ / "gold.toml", shipped("mem-gold.toml"));
    write(path_ / "pzt.toml", shipped("mem-gold-pzt.toml"));
  }
  ~Workplace() {
    std::error_code ignored;
    fs::remove_all(path_, ignored);
  }
  Workplace(const Workplace&) = delete;
  Workplace& operator=(const Workplace&) = delete;

  [[nodiscard]] const fs::path& path() const { return path_; }

  static constexpr int to_file = -1, closed = -2;

  /// Starts the program. `out` is its standard output: a descriptor, `to_file` or `closed`; `err` is its standard error. If
  /// there is a file stdin.txt, it is the standard input.
  [[nodiscard]] pid_t start(const std::vector<std::string>& words, const std::string& program = SOFTLAND_PROGRAM,
                            int out = to_file, int err = to_file) const {
    std::vector<char*> arguments{const_cast<char*>(program.c_str())};
    for (const std::string& word : words) arguments.push_back(const_cast<char*>(word.c_str()));
    arguments.push_back(nullptr);
    posix_spawn_file_actions_t actions;
    posix_spawn_file_actions_init(&actions);
    posix_spawn_file_actions_addchdir_np(&actions, path_.c_str());
    posix_spawn_file_actions_addopen(&actions, 0, fs::exists(path_ / "stdin.txt") ? "stdin.txt" : "/dev/null", O_RDONLY, 0);
    const auto connect = [&](int stream, int to, const char* file) {
      if (to == to_file) {
        posix_spawn_file_actions_addopen(&actions, stream, file, O_WRONLY | O_CREAT | O_TRUNC, 0600);
      } else if (to == closed) {
        posix_spawn_file_actions_addclose(&actions, stream);
      } else {
        posix_spawn_file_actions_adddup2(&actions, to, stream);
      }
    };
    connect(1, out, "stdout.txt");
    connect(2, err, "stderr.txt");
    // Restore the default signal handling, even if the tests were started with signals ignored.
    posix_spawnattr_t attributes;
    posix_spawnattr_init(&attributes);
    sigset_t all;
    sigfillset(&all);
    posix_spawnattr_setsigdefault(&attributes, &all);
    posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETSIGDEF);
    pid_t child = 0;
    const int error = posix_spawn(&child, program.c_str(), &actions, &attributes, arguments.data(), environ);
    posix_spawn_file_actions_destroy(&actions);
    posix_spawnattr_destroy(&attributes);
    if (error != 0) throw std::runtime_error("cannot start " + program);
    return child;
  }
  [[nodiscard]] Outcome finish(pid_t child) const {
    int status = 0;
    waitpid(child, &status, 0);
    return {WIFEXITED(status) ? WEXITSTATUS(status) : -WTERMSIG(status), read(path_ / "stdout.txt"), read(path_ / "stderr.txt")};
  }
  [[nodiscard]] Outcome run(const std::vector<std::string>& words, const std::string& program = SOFTLAND_PROGRAM,
                            int out = to_file) const {
    return finish(start(words, program, out));
  }

 private:
  fs::path path_;
};

/// Returns the keys of a JSON object.
inline std::set<std::string> keys(const nlohmann::json& object) {
  std::set<std::string> all;
  for (const auto& [key, value] : object.items()) all.insert(key);
  return all;
}

}  // namespace softland
