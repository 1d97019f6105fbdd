// The verbs that look at a scene (verbs/study.h), in Python: its methods are made of their descriptions by the build, and checked
// and worded as the options of the program.
#include <pybind11/stl.h>

#include <algorithm>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "python/scene.h"
#include "reports/result_json.h"
#include "studies/closing/auto_settings.h"
#include "verbs/study.h"

namespace softland::python {

namespace py = pybind11;

namespace {

// A message with the names of options as Python has them.
std::string in_keywords(const verbs::Study& study, const InvalidRequest& error) {
  constexpr char before_option = '\x02';
  std::string text;
  const std::string marked = error.with_fields(std::string(1, before_option));
  for (std::size_t i = 0; i < marked.size(); ++i) {
    if (marked[i] != before_option) {
      text += marked[i];
      continue;
    }
    const std::string_view rest = std::string_view(marked).substr(i + 1);
    const auto option = std::ranges::find_if(study.options, [&](const verbs::OptionRow& one) {
      return rest.starts_with(one.name + ' ') || rest.starts_with(one.name + ':');
    });
    if (option == study.options.end()) continue;
    text += option->keyword;
    i += option->name.size();
  }
  return text;
}

// Waveforms of others, by the names of the user.
std::map<std::string, DriveWaveforms> others_of(const py::dict& given, Run& run) {
  std::map<std::string, DriveWaveforms> others;
  for (const auto& [name, waveforms] : given)
    others.emplace(name.cast<std::string>(), waveforms_of(waveforms.cast<py::dict>(), run));
  return others;
}

}  // namespace

Outcome study(PyScene& scene, const std::string& verb, const verbs::Told& told, const py::dict& waveforms, std::string command,
              const py::object& progress) {
  const std::vector<verbs::Study>& all = verbs::all_studies();
  const auto found = std::ranges::find_if(all, [&](const verbs::Study& one) { return one.name == verb; });
  require(found != all.end(), [&] { return "there is no verb '" + verb + "'"; });
  const auto in_python = [&](const auto& work) {
    try {
      return work();
    } catch (const InvalidRequest& error) {
      throw InvalidInput(in_keywords(*found, error));
    }
  };
  const auto ask = in_python([&] { return found->ask(told); });
  Run run(progress);
  const std::map<std::string, DriveWaveforms> others = others_of(waveforms, run);
  const SceneFile file = scene.file;  // another Python thread may change it meanwhile
  std::shared_ptr<const PreparedScene> plain = scene.plain, limited = scene.limited;
  const auto outcome = in_python([&] {
    return run([&](const Watch& watch) {
      const auto prepared = [&](bool default_limits) {
        std::shared_ptr<const PreparedScene>& kept = default_limits ? limited : plain;
        if (!kept) kept = std::make_shared<const PreparedScene>(prepare_and_choose(file, default_limits, watch));
        return kept;
      };
      const auto driven = [&](const std::string& name, const PreparedScene& nominal) {
        const std::shared_ptr<const PreparedScene> alias(std::shared_ptr<const PreparedScene>(), &nominal);
        DriveWaveforms all_drives = nominal.drives.waveforms();
        for (auto& [drive, waveform] : driven_by(alias, others.at(name))->drives.waveforms()) all_drives[drive] = waveform;
        return all_drives;
      };
      verbs::Outcome all_of_it = ask({.scene = file,
                                      .name = file.name(),
                                      .command = command,
                                      .watch = watch,
                                      .prepared = prepared,
                                      .load = [](const std::string& path) { return SceneFile::load(path); },
                                      .waveforms_of = driven,
                                      .text = [&] { return file.text(); }});
      watch.throw_if_stopped();
      return all_of_it;
    });
  });
  scene.plain = plain, scene.limited = limited;
  Outcome result{.json = json_text(outcome.json)};
  for (const verbs::Outcome::File& one : outcome.files) result.files[one.name] = one.text;
  return result;
}

}  // namespace softland::python
