#pragma once

// Catalogue files to open, damage and fill, and the errors that come of it.

#include <filesystem>
#include <functional>
#include <iterator>
#include <stdexcept>
#include <string>
#include <vector>

#include <SQLiteCpp/SQLiteCpp.h>
#include <catch2/catch.hpp>
#include <sys/wait.h>
#include <unistd.h>

#include "dowel/catalog/catalog.h"
#include "dowel/kernel/error.h"
#include "program.h"
#include "records.h"

namespace dowel::testing {

inline Catalog writable(const std::filesystem::path& file) {
  return Catalog(file, Catalog::Access::ReadWrite);
}

inline Catalog readable(const std::filesystem::path& file) {
  return Catalog(file, Catalog::Access::ReadOnly);
}

inline std::vector<std::string> put(Catalog& catalog, const std::string& path,
                                    const std::vector<ElementRecord>& records) {
  return catalog.put(block_source(path), records);
}

/// The error that `body` throws; fails where it throws none.
inline Error error_of(const std::function<void()>& body) {
  try {
    body();
  } catch (const Error& error) {
    return error;
  }
  FAIL("no error was thrown");
  throw std::logic_error("unreachable");
}

inline void execute(const std::filesystem::path& file, const std::string& sql) {
  SQLite::Database database(file.string(), SQLite::OPEN_READWRITE | SQLite::OPEN_CREATE);
  database.exec(sql);
}

/// Reads all there is in a catalogue.
inline void read_all(const std::filesystem::path& file) {
  const Catalog catalog = readable(file);
  for (const std::string& name : catalog.names()) {
    catalog.find(name);
    catalog.solid(name);
    catalog.brep(name);
  }
  catalog.source("blocks/block.step");
  catalog.similar_names("blok");
}

/// A catalogue of a few elements, as bytes.
inline std::string sample_bytes(const TemporaryFolder& folder) {
  const auto file = folder / "sample.db";
  Catalog catalog = writable(file);
  put(catalog, "blocks/block.step", {block_record("H40/block"), block_record("H40/slab", 120.0)});
  put(catalog, "other.step", {block_record("H40/block", 60.0)});
  return read_text(file);
}

inline std::size_t files_in(const TemporaryFolder& folder) {
  const std::filesystem::directory_iterator files(folder.path());
  return static_cast<std::size_t>(std::distance(begin(files), end(files)));
}

/// Runs `body` in a child process and returns its wait status.
inline int in_child(const std::function<void()>& body) {
  const pid_t child = ::fork();
  if (child == 0) {
    try {
      body();
    } catch (...) {
      ::_exit(99);
    }
    ::_exit(0);
  }
  int status = 0;
  ::waitpid(child, &status, 0);
  return status;
}

}  // namespace dowel::testing
