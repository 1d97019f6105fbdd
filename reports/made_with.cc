#include "reports/made_with.h"

#include <elf.h>
#include <fmt/format.h>
#include <gnu/libc-version.h>
#include <link.h>

#include <cstring>
#include <sstream>
#include <string_view>
#include <vector>

#include "base/read_file.h"
#include "base/require.h"
#include "model/ensemble/ensemble_closings.h"
#include "reports/closing_members.h"
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

}  // namespace softland
