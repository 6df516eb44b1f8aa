#include <string>
#include <string_view>

#include "dowel/io/file.h"
#include "dowel/io/scene_page.h"
#include "html_text.h"
#include "page_template.h"

namespace dowel {

std::string to_page(const DisplayScene& scene) {
  static constexpr std::string_view kTitle = "@TITLE@";
  static constexpr std::string_view kScene = "@SCENE@";
  const std::string_view page = page_template();
  const std::size_t title = page.find(kTitle);
  const std::size_t model = page.find(kScene);
  std::string html(page.substr(0, title));
  html += escaped_html(scene.title.empty() ? "Assembly" : scene.title);
  html += page.substr(title + kTitle.size(), model - title - kTitle.size());
  html += base64(to_glb(scene));
  html += page.substr(model + kScene.size());
  return html;
}

void write_page(const std::filesystem::path& file, const DisplayScene& scene) {
  write_file(file, to_page(scene));
}

}  // namespace dowel
