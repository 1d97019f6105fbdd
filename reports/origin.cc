#include "reports/origin.h"

#include <elf.h>
#include <fmt/format.h>
#include <gnu/libc-version.h>
#include <link.h>

#include <cstring>
#include <sstream>
#include <string_view>
#include <utility>
#include <vector>

#include "base/read_file.h"
#include "base/require.h"
#include "model/ensemble/ensemble_closings.h"
#include "reports/record.h"
#include "version.h"

namespace softland {
namespace {

using nlohmann::json;

constexpr std::string_view instruction_set =
#if defined(__AVX512F__)
    "AVX-512";
#elif defined(__AVX2__) && defined(__FMA__)
    "AVX2 and FMA";
#elif defined(__aarch64__)
    "AArch64";
#elif defined(__x86_64__)
    "SSE2";
#else
    "";
#endif

// Returns the hash of the program, from a note that the linker writes. The first loaded object is the program itself.
std::string build_id() {
  std::string id;
  dl_iterate_phdr(
      [](dl_phdr_info* object, std::size_t, void* found) {
        for (int i = 0; i < object->dlpi_phnum; ++i) {
          const auto& segment = object->dlpi_phdr[i];
          if (segment.p_type != PT_NOTE) continue;
          // NOLINTNEXTLINE(performance-no-int-to-ptr): the loader gives addresses as integers
          const auto* at = reinterpret_cast<const char*>(object->dlpi_addr + segment.p_vaddr);
          const char* end = at + segment.p_memsz;
          while (at + sizeof(ElfW(Nhdr)) <= end) {
            ElfW(Nhdr) note;
            std::memcpy(&note, at, sizeof note);
            const auto padded = [](std::size_t size) { return (size + 3) / 4 * 4; };
            const char* name = at + sizeof note;
            const char* content = name + padded(note.n_namesz);
            if (note.n_type == NT_GNU_BUILD_ID && std::string_view(name, note.n_namesz) == std::string_view("GNU\0", 4)) {
              for (const char* byte = content; byte < content + note.n_descsz; ++byte) {
                *static_cast<std::string*>(found) += fmt::format("{:02x}", static_cast<unsigned char>(*byte));
              }
              return 1;
            }
            at = content + padded(note.n_descsz);
          }
        }
        return 1;
      },
      &id);
  return id;
}

std::string processor() {
  try {
    std::istringstream lines(read_file("/proc/cpuinfo"));
    for (std::string line; std::getline(lines, line);) {
      const std::size_t colon = line.find(": ");
      if (line.starts_with("model name") && colon != std::string::npos) return line.substr(colon + 2);
    }
  } catch (const InvalidInput&) {  // some machines have no /proc/cpuinfo, and then the processor's name stays unknown
  }
  return {};
}

}  // namespace

void members(internal::Archive& a, MadeWith& made) {
  using internal::OrNull;
  a("program", OrNull{made.program}, "hash of the program");
  a("compiler", OrNull{made.compiler}, "compiler that built the program");
  a("options", OrNull{made.options}, "compiler options");
  a("instruction_set", OrNull{made.instruction_set}, "instructions for which the program was built");
  a("vectors", OrNull{made.vectors}, "vector instructions in use");
  a("c_library", OrNull{made.c_library}, "C library");
  a("processor", OrNull{made.processor}, "processor of the machine");
}

void members(internal::Archive& a, Origin& origin) {
  a("kind", origin.kind, "verb that made the record");
  a("version", origin.version, "version of softland");
  a("made_with", origin.made_with, "what the last digits of the numbers depend on");
  a("command", origin.command, "command line");
  if (a.has(!origin.scene.is_null()))
    a("scene", origin.scene, "scene with all defaults, by section and key; quantities are texts");
  if (a.has(!origin.scene_toml.empty())) a("scene_toml", origin.scene_toml, "the same scene as the text of a scene file");
}

const MadeWith& made_with() {
  static const MadeWith all{.program = build_id(),
                            .compiler = std::string(compiler),
                            .options = std::string(compiler_options),
                            .instruction_set = std::string(instruction_set),
                            .vectors = std::string(name_of(vector_instructions, vectors_in_use())),
                            .c_library = fmt::format("glibc {}", gnu_get_libc_version()),
                            .processor = processor()};
  return all;
}

json made_with_json(const MadeWith& all) { return internal::record_json(all); }

std::string internal::made_with_text(const MadeWith& all) {
  const bool in_lanes = !all.vectors.empty() && all.vectors != name_of(vector_instructions, Vectors::none);
  std::vector<std::string> words{all.compiler,
                                 all.options,
                                 all.instruction_set,
                                 in_lanes ? fmt::format("ensembles by {}", all.vectors) : "",
                                 all.c_library,
                                 all.processor,
                                 all.program.empty() ? "" : "program " + all.program.substr(0, 12)};
  std::erase(words, "");
  return fmt::format("{}", fmt::join(words, ", "));
}

using nlohmann::json;

Origin origin_of(const char* kind, const std::string& command) {
  return {.kind = kind, .version = std::string(version), .command = command, .made_with = made_with()};
}

Origin origin_of(const char* kind, const PreparedScene& scene, const std::string& command) {
  Origin origin = origin_of(kind, command);
  origin.scene = scene.resolved().json();
  return origin;
}

Origin whole_origin_of(const char* kind, const PreparedScene& scene, const std::string& command) {
  Origin origin = origin_of(kind, scene, command);
  origin.scene_toml = scene.resolved().text();
  return origin;
}

MadeAgain made_again(const Origin& origin, std::optional<std::uint64_t> seed, double tolerance) {
  return {.version = origin.version,
          .command = origin.command,
          .made_with = internal::made_with_text(origin.made_with),
          .scene = origin.scene_toml,
          .seed = seed,
          .tolerance = tolerance};
}

std::string title_of(const Origin& origin) {
  const auto title = origin.scene.find("title");
  return title != origin.scene.end() && title->is_string() ? title->get<std::string>() : std::string();
}

json with_origin(json record, const std::string& command) {
  record.update({{"version", version}, {"made_with", made_with_json()}, {"command", command}});
  return record;
}

json with_origin(json record, const PreparedScene& scene, const std::string& command) {
  record["scene"] = scene.resolved().json();
  return with_origin(std::move(record), command);
}

StoredOrigin stored_origin(const std::string& command) {
  const MadeWith& m = made_with();
  return {.program = m.program,
          .processor = fmt::format("{}, {}, {}, {}", m.processor, m.instruction_set, m.vectors, m.c_library),
          .command = command};
}

}  // namespace softland
