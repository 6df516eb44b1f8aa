#include "console_export.h"

#include <algorithm>
#include <map>
#include <vector>

#include "console_text.h"
#include "dowel/io/file.h"
#include "dowel/io/scene_page.h"
#include "dowel/io/snapshot.h"
#include "dowel/io/step_writer.h"

namespace dowel::tools {
namespace {

/// Elements of the placed instances, numbered by name.
std::map<std::string, std::size_t> numbered_elements(const Session& session) {
  std::map<std::string, std::size_t> numbers;
  for (const auto& [name, instance] : session.state().instances) numbers[instance.element] = 0;
  std::size_t next = 0;
  for (auto& [element, number] : numbers) number = next++;
  return numbers;
}

std::string title_of(const Session& session) {
  const std::string stem = session.project().file().stem().string();
  return stem.empty() ? "assembly" : stem;
}

/// What `touch` says of `name`, which is one of its two.
std::string note_on(const Touch& touch, const std::string& name) {
  const std::string& other = touch.instance == name ? touch.with : touch.instance;
  return std::string(to_string(touch.pair.verdict)) + " with " + other;
}

DisplayScene display_scene(Session& session) {
  DisplayScene scene;
  scene.title = title_of(session);
  const std::map<std::string, std::size_t> numbers = numbered_elements(session);
  for (const auto& [name, number] : numbers) {
    DisplayMesh mesh;
    mesh.name = name;
    mesh.solid = session.solid(name);
    mesh.colour = session.element(name).colour.value_or(mesh.colour);
    scene.meshes.push_back(std::move(mesh));
  }
  const std::vector<Touch> touches = session.check_all();
  for (const Instance* instance : session.state().in_order()) {
    DisplayInstance display{
        instance->name, numbers.at(instance->element), instance->X_WI, DisplayState::Normal, {}};
    for (const Verdict verdict : {Verdict::Interference, Verdict::Contact}) {
      for (const Touch& touch : touches) {
        const bool concerned = touch.instance == display.name || touch.with == display.name;
        if (!concerned || touch.pair.verdict != verdict) continue;
        if (display.state == DisplayState::Normal) {
          display.state =
              verdict == Verdict::Interference ? DisplayState::Colliding : DisplayState::Contact;
        }
        display.note += (display.note.empty() ? "" : ", ") + note_on(touch, display.name);
      }
    }
    scene.instances.push_back(std::move(display));
  }
  return scene;
}

void export_step(Session& session, const std::filesystem::path& file) {
  const std::map<std::string, std::size_t> numbers = numbered_elements(session);
  std::vector<ExportPart> parts;
  for (const auto& [name, number] : numbers) {
    std::vector<std::byte> brep = session.project().brep(name);
    if (brep.empty()) {
      throw Error(ErrorCode::InvalidInput,
                  "element " + name +
                      " has no boundary representation (it came from a mesh): expected an ending "
                      "of .glb or .html");
    }
    parts.push_back({name, std::move(brep), session.element(name).colour});
  }
  std::vector<ExportInstance> instances;
  for (const Instance* instance : session.state().in_order()) {
    instances.push_back({instance->name, numbers.at(instance->element), instance->X_WI});
  }
  write_step_assembly(file, title_of(session), parts, instances);
}

std::string csv_field(const std::string& text) {
  if (text.find_first_of(",\"\r\n") == std::string::npos) return text;
  std::string field = "\"";
  for (const char c : text) {
    if (c == '"') field += '"';
    field += c;
  }
  return field + "\"";
}

}  // namespace

std::string bom_csv(Session& session) {
  std::string csv = "count,name,family,instances\r\n";
  for (const BomRow& row : session.bill_of_materials()) {
    std::string instances;
    for (const std::string& name : row.instances) {
      instances += (instances.empty() ? "" : " ") + name;
    }
    csv += std::to_string(row.count) + "," + csv_field(row.element) + "," + csv_field(row.family) +
           "," + csv_field(instances) + "\r\n";
  }
  return csv;
}

std::string journal_script(const Session& session) {
  std::string script;
  for (const JournalEntry& entry : session.project().journal()) {
    if (!entry.undone) script += entry.command + "\n";
  }
  return script;
}

void export_session(Session& session, const std::filesystem::path& file) {
  std::string ending = file.extension().string();
  std::ranges::transform(ending, ending.begin(), [](char c) {
    return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
  });
  if (ending == ".step" || ending == ".stp") {
    export_step(session, file);
  } else if (ending == ".glb") {
    write_glb(file, display_scene(session));
  } else if (ending == ".html") {
    write_page(file, display_scene(session));
  } else if (ending == ".png") {
    write_png(file, display_scene(session));
  } else if (ending == ".csv") {
    write_file(file, bom_csv(session));
  } else if (ending == ".dowel") {
    // Whoever exports over a project has mistaken this for `save`.
    if (std::filesystem::exists(file) && looks_like_project(file)) {
      throw Error(ErrorCode::InvalidInput,
                  file.string() + ": is a project; an export would replace it by a script");
    }
    write_file(file, journal_script(session));
  } else {
    throw Error(
        ErrorCode::InvalidInput,
        file.string() +
            ": unknown ending, expected .step, .glb, .html, .png, .csv or .dowel (a script)");
  }
}

}  // namespace dowel::tools
