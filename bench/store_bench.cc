// Measures a store of studies: bench_store FOLDER [ROWS]
//
// Writes, continues, reads, finds by content and merges rows like those of an exploration, with two variables and thirteen
// figures. The files stay in FOLDER; the times depend on its disk.
#include <fmt/format.h>
#include <sys/resource.h>

#include <chrono>
#include <cmath>
#include <cstdlib>
#include <exception>
#include <filesystem>
#include <functional>
#include <iostream>
#include <string>
#include <vector>

#include "store/study_store.h"

namespace softland {
namespace {

namespace fs = std::filesystem;
using Opening = StudyStore::Opening;

StoredPlan plan_of(std::int64_t points, Shard shard = {}) {
  StoredPlan plan{.text = fmt::format("plan of {} points", points), .points = points, .columns = {}, .shard = shard};
  for (const auto& [key, unit] : {std::pair("structure_length_m", "m"), std::pair("gap_contact_m", "m")})
    plan.columns.push_back({.key = key, .name = key, .unit = unit, .kind = ColumnKind::variable});
  for (const char* key : {"initial_contact_time_s", "permanent_contact_time_s", "bounce_time_s", "bounce_count",
                          "major_bounce_height_m", "impact_velocity_m_s", "peak_contact_force_N", "impact_energy_J",
                          "hold_force_N", "drive_energy_J", "peak_voltage_V", "peak_slew_V_s", "settled"})
    plan.columns.push_back({.key = key, .name = key, .unit = "", .kind = ColumnKind::figure});
  return plan;
}

// Times and other real numbers take eight bytes, counts one.
StoredRow row_of(std::int64_t point) {
  const double at = std::fmod(static_cast<double>(point) * 0.6180339887498949, 1);
  StoredRow row{.point = point, .content = content_key(std::to_string(point)), .status = "done", .values = {}};
  for (int i = 0; i < 15; ++i) row.values.push_back(std::sqrt(at + i) * 1e-6);
  row.values[5] = std::floor(40 * at);
  row.values[12] = 45;
  row.values[14] = at < 0.9 ? 1 : 0;
  return row;
}

double seconds_of(const std::function<void()>& work) {
  const auto begin = std::chrono::steady_clock::now();
  work();
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
}

double processor_seconds() {
  rusage used{};
  ::getrusage(RUSAGE_SELF, &used);
  const auto seconds = [](const timeval& t) { return static_cast<double>(t.tv_sec) + 1e-6 * static_cast<double>(t.tv_usec); };
  return seconds(used.ru_utime) + seconds(used.ru_stime);
}

void write(const fs::path& file, const StoredPlan& plan) {
  StudyStore store(file, plan, {.program = "bench_store", .processor = "", .command = ""}, Opening::resume);
  const std::vector<bool> done = store.done();
  for (std::int64_t point = 0; point < plan.points; ++point) {
    if (plan.shard.contains(point) && !done[static_cast<std::size_t>(point)]) store.add(row_of(point));
  }
  store.close();
}

void print(const std::string& what, std::int64_t rows, double seconds, double processor) {
  fmt::print("| {} | {} | {:.2f} s | {:.0f} | {:.2f} µs |\n", what, rows, seconds, static_cast<double>(rows) / seconds,
             1e6 * processor / static_cast<double>(rows));
  std::fflush(stdout);
}

void measure(const std::string& what, std::int64_t rows, const std::function<void()>& work) {
  const double before = processor_seconds();
  const double seconds = seconds_of(work);
  print(what, rows, seconds, processor_seconds() - before);
}

int run(const fs::path& folder, std::int64_t rows) {
  fs::create_directories(folder);
  const fs::path file = folder / "whole.sqlite";
  fmt::print("| what | rows | time | rows/s | processor time per row |\n|---|---|---|---|---|\n");
  measure("write", rows, [&] { write(file, plan_of(rows)); });
  const auto size = fs::file_size(file);
  measure("go on: which points are done", rows, [&] { write(file, plan_of(rows)); });
  measure("read all", rows, [&] { StudyReader(file).read([](const StoredRow&) {}); });
  measure("read one in ten, by an expression", rows,
          [&] { StudyReader(file).read([](const StoredRow&) {}, {.where = "bounce_count < 4"}); });
  constexpr int count = 8;
  std::vector<fs::path> parts;
  for (int index = 1; index <= count; ++index) {
    parts.push_back(folder / fmt::format("part-{}.sqlite", index));
    write(parts.back(), plan_of(rows, {.index = index, .count = count}));
  }
  measure(fmt::format("merge {} parts", count), rows,
          [&] { static_cast<void>(merge_studies(parts, folder / "merged.sqlite", {})); });
  measure("a plan of twice as many points: find and take over", rows, [&] {
    StudyStore store(file, plan_of(2 * rows), {}, Opening::resume);
    for (std::int64_t point = 0; point < rows; ++point) {
      if (auto known = store.find(row_of(point).content)) store.add(*std::move(known));
    }
    store.close();
  });
  fmt::print("\n{:.0f} bytes per row.\n", static_cast<double>(size) / static_cast<double>(rows));
  return EXIT_SUCCESS;
}

}  // namespace
}  // namespace softland

int main(int argc, char** argv) {
  if (argc < 2 || argc > 3) {
    std::cerr << "usage: bench_store FOLDER [ROWS]\n";
    return EXIT_FAILURE;
  }
  try {
    return softland::run(argv[1], argc > 2 ? std::atoll(argv[2]) : 1'000'000);
  } catch (const std::exception& error) {
    std::cerr << error.what() << '\n';
    return EXIT_FAILURE;
  }
}
