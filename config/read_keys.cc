#include "config/read_keys.h"

#include "config/drives.h"
#include "config/scene.h"
#include "config/section_reader.h"

namespace softland {
namespace internal {
namespace {

void read_place(const SectionReader& in, std::string_view key, std::string& name, int& number) {
  if (!in.is_given(key)) return;
  if (in.is_word(key)) {
    name = in.text(key);
    in.require(!name.empty(), key, "must be the name or the number of a column");
  } else {
    number = in.integer(key);
  }
}

}  // namespace

ReadKeys read_keys(const SectionReader& in) {
  ReadKeys keys;
  read_place(in, file_keys::column, keys.column, keys.column_number);
  read_place(in, file_keys::time_column, keys.time_column, keys.time_column_number);
  if (in.is_given(file_keys::interval)) {
    keys.uneven = in.is_word(file_keys::interval);
    if (!keys.uneven) keys.interval = in.number(file_keys::interval);
  }
  if (in.is_given(file_keys::skip)) keys.skip = in.integer(file_keys::skip);
  if (in.is_given(file_keys::unit)) keys.unit = in.text(file_keys::unit);
  if (in.is_given(file_keys::time_unit)) keys.time_unit = in.text(file_keys::time_unit);
  if (in.is_given(file_keys::decimal)) keys.decimal = in.text(file_keys::decimal).front();
  return keys;
}

}  // namespace internal

ReadKeys read_keys(const std::vector<std::string>& assignments) {
  SceneFile file = SceneFile::parse("[waveform.main]\nfamily = \"table\"\nfile = \"-\"\n", "--set");
  for (const std::string& assignment : assignments) file.set("waveform.main." + assignment);
  const internal::SectionReader in(file.impl(), "waveform", "main");
  for (const std::string_view key :
       {internal::file_keys::unit, internal::file_keys::scale, internal::file_keys::shift, internal::before_key})
    in.require(!in.is_given(key), key,
               "is not a key for reading a file; choose column, time_column, interval, skip, time_unit or decimal");
  return internal::read_keys(in);
}

}  // namespace softland
