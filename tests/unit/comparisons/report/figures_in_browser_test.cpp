// The report's figures, drawn by Chromium.
#include <algorithm>
#include <set>

#include "comparisons/report/png_page.h"
#include "support/sample_case.h"
#include "unit/comparisons/report/report_page.h"

namespace springproof::figures_in_browser_test {
namespace {

using Json = nlohmann::json;

/// The sample with a smooth surface, tetrahedra, and the parts of its errors.
CaseResult embedded_case() {
  CaseResult c = sample_case();
  for (const char* model : {"fem", "hybmss"}) {
    Picture p = sample_picture(model, 0.4);
    p.surface = "smooth";
    p.displacement = {0, 0, 0, 0.1f, 0, 0, 0.1f, 0.05f, 0, 0, 0, 0.02f};  // many colours
    p.quads = {0, 1, 2, -1, 0, 2, 3, -1};
    c.pictures.push_back(p);
  }
  c.rows.push_back(
      {{"fem_p1", 0.4, {812, 0, 0}}, "compress", "linear", "displacement_error", 0.01, "1", {}, 0.001, 0.01});
  return c;
}

std::vector<ErrorSplit> some_splits() {
  std::vector<ErrorSplit> splits;
  for (double nu : {0.25, 0.4})
    for (int n : {1, 2})
      splits.push_back(
          {{"hybmss", nu, {n, n, n}}, 1.0 / n, "volume_change", "1", 0.03 / n, -0.01 / n, 0.025 / n, 0.015 / n, 0.001});
  return splits;
}

class FiguresInBrowser : public ReportInBrowser {
 protected:
  /// The page of embedded_case() with the parts of its errors and a script that runs after its own.
  std::string open_with(const std::string& script, const std::string& fragment = "",
                        const std::string& options = whole_page) {
    CaseResult c = embedded_case();
    c.splits = some_splits();
    return ReportInBrowser::open_with({c}, pictures({c}), script, fragment, options);
  }
};

TEST_F(FiguresInBrowser, EveryFigureIsDrawn) {
  const std::string dom = open_with(tools + R"js(
    const canvases = () => [...document.querySelectorAll('section canvas')].filter(canvas => !canvas.closest('[hidden]'));
    until(() => canvases().length > 4 && canvases().every(drawn), () => {
      for (const canvas of canvases()) say(canvas.closest('section').id + (drawn(canvas) ? ' drawn' : ' blank'));
      endLoading();
    });
  )js");
  expect_no_complaint(dom);
  EXPECT_EQ(count(dom, "<p class=\"said\">poisson drawn"), 2u);
  EXPECT_EQ(count(dom, "<p class=\"said\">convergence drawn"), 1u);
  EXPECT_EQ(count(dom, "<p class=\"said\">splits drawn"), 1u) << "of all models at one nu";
  EXPECT_EQ(count(dom, "<p class=\"said\">shapes drawn"), 1u);
  EXPECT_EQ(count(dom, " blank</p>"), 0u);
  EXPECT_EQ(count(dom, "<button type=\"button\" class=\"png\""), 6u) << "one per figure";
  EXPECT_NE(dom.find("<option value=\"812 tets\">812 tets</option>"), std::string::npos);
  EXPECT_NE(dom.find("the springs against finite elements (eight-node bricks) on the same voxels"), std::string::npos);
  EXPECT_NE(dom.find("<b>1.5000</b>"), std::string::npos) << "total of the finer cells in percent, in the table";
}

TEST_F(FiguresInBrowser, HistoriesAreDrawnBesideWhatWasMeasured) {
  CaseResult c = embedded_case();
  for (const double time : {0.5, 2.0}) {
    ValidatedValue v = of_run<ValidatedValue>({"hybmss", 0.4, {2, 2, 2}});
    v.name = "creep, " + std::to_string(time) + " s";
    v.quantity = "mean_displacement.z_max.z";
    v.unit = "m";
    v.measured = 0.001 * time;
    v.u_measured = 1e-4;
    v.simulated = 0.0011 * time;
    v.history = "creep";
    v.time = time;
    c.validation.push_back(v);
  }
  const std::string dom = ReportInBrowser::open_with({c}, pictures({c}), tools + R"js(
    const canvases = () => [...document.querySelectorAll('#measured canvas')];
    until(() => canvases().length === 2 && drawn(canvases()[1]), () => {
      say('history ' + (drawn(canvases()[1]) ? 'drawn' : 'blank'));
      const [drawing] = historyDrawings(cases[0]), sets = drawing.make().data.datasets;
      say(drawing.name + ': ' + sets.map(set => set.data.map(p => p.x + ' s ' + p.y.toFixed(2)).join(', ')).join(' | '));
      endLoading();
    });
  )js",
                                                     "", whole_page);
  expect_no_complaint(dom);
  EXPECT_NE(dom.find("history drawn<"), std::string::npos) << said(dom);
  EXPECT_NE(
      dom.find("measured-history-1: 0.5 s 0.50, 2 s 2.00 | 0.5 s 0.55, 2 s 2.20 | 0.5 s 0.70, 2 s 2.20 | 0.5 s 0.30, "
               "2 s 1.80<"),
      std::string::npos)
      << said(dom);
}

TEST_F(FiguresInBrowser, FirstScreenShowsTwoBodiesAndADotPerModelAndCase) {
  const std::string dom = open_with(tools + R"js(
    const canvas = () => document.querySelector('#first-bodies canvas');
    until(() => canvas() && drawn(canvas()), () => {
      say('bodies ' + (drawn(canvas()) ? 'drawn' : 'blank') + ' in ' + document.querySelectorAll('#first-bodies .panel').length);
      const dots = () => [...document.querySelectorAll('.dot:not(.pale)')].map(dot => dot.title).join('; ');
      const slider = document.querySelector('#first-plot input[type=range]');
      say('worst: ' + dots());
      slider.value = 1;
      slider.dispatchEvent(new Event('input'));
      say('first: ' + dots());
      say('facts: ' + document.querySelector('#first-facts').textContent);
      endLoading();
    });
  )js",
                                    "", one_screen);
  expect_no_complaint(dom);
  EXPECT_NE(dom.find("bodies drawn in 2"), std::string::npos) << said(dom);
  EXPECT_NE(dom.find("worst: hybmss, compress: 2.0 % at ν = 0.4; fem_p1, compress: 1.0 % at ν = 0.4<"),
            std::string::npos)
      << said(dom);
  EXPECT_NE(dom.find("first: hybmss, compress: 0.50 % at ν = 0.25"), std::string::npos) << said(dom);
  EXPECT_NE(dom.find("facts: Displacement of hybmsscompress"), std::string::npos) << said(dom);
}

TEST_F(FiguresInBrowser, ACasePageStartsWithTheBodyItsSupportsAndLoads) {
  const std::string dom = open_with(tools + R"js(
    const page = document.querySelector('details.case');
    page.open = true;
    page.fill();
    const picture = page.querySelector('.case-body').firstElementChild, viewer = picture.querySelector('.viewer');
    page.scrollIntoView({behavior: 'instant'});
    const canvas = () => viewer.querySelector('canvas');
    until(() => canvas() && drawn(canvas()), () => {
      say('panels ' + [...viewer.querySelectorAll('.panel-label')].map(label => label.textContent).join(' | '));
      say('then ' + picture.nextElementSibling.textContent.slice(0, 120));
      say('text ' + canvas().getAttribute('aria-label'));
      const before = pixelsOf(canvas()).join(), turned = () => pixelsOf(canvas()).join() !== before;
      viewer.dispatchEvent(new KeyboardEvent('keydown', {key: 'ArrowLeft', bubbles: true}));
      until(turned, () => { say(turned() ? 'turned' : 'still'); endLoading(); });
    });
  )js",
                                    "", one_screen);
  expect_no_complaint(dom);
  EXPECT_NE(dom.find("panels The problemheldmoved | FEM reference"), std::string::npos) << said(dom);
  EXPECT_NE(dom.find("then fail 1 of 2 hold. Largest displacement errors: hybmss 2.0 %"), std::string::npos)
      << said(dom);
  EXPECT_NE(dom.find("text compress: z_min: held; z_max: moved by -0.05 m in z, held in x and y."), std::string::npos)
      << said(dom);
  EXPECT_NE(dom.find("<p class=\"said\">turned"), std::string::npos) << "by an arrow key" << said(dom);
}

TEST_F(FiguresInBrowser, OfASinglePoissonsRatioThereAreBarsInOrder) {
  const std::string dom = open_with(tools + R"js(
    const only = cases[0];
    const drawing = poissonDrawing([{...only, rows: only.rows.filter(row => row.poisson_ratio === 0.4)}], 'displacement_error', 'finest', true);
    const chart = drawing.make();
    say('chart ' + chart.type + ': ' + chart.data.datasets[0].data.map(bar => `${bar.model} ${bar.error.toPrecision(2)}`).join(', '));
    endLoading();
  )js");
  expect_no_complaint(dom);
  EXPECT_NE(dom.find("chart bar: fem_p1 1.0, hybmss 2.0<"), std::string::npos) << said(dom);
}

TEST_F(FiguresInBrowser, OneDragTurnsAllBodies) {
  const std::string dom = open_with(tools + R"js(
    const viewer = document.querySelector('#shapes .viewer'), canvas = viewer.querySelector('canvas');
    viewer.scrollIntoView({behavior: 'instant', block: 'center'});
    const panels = () => [...viewer.querySelectorAll('.panel')].map(panel => {
      const all = viewer.getBoundingClientRect(), box = panel.getBoundingClientRect(), scale = canvas.width / all.width;
      const copy = document.createElement('canvas');
      [copy.width, copy.height] = [box.width * scale, (box.height - 46) * scale];
      const ctx = copy.getContext('2d');
      ctx.drawImage(canvas, -(box.left - all.left) * scale, -(box.top + 46 - all.top) * scale);
      return ctx.getImageData(0, 0, copy.width, copy.height).data.join();
    });
    const mouse = (target, type, x) => target.dispatchEvent(new MouseEvent(type, {bubbles: true, button: 0, clientX: x, clientY: 300}));
    until(() => drawn(canvas), () => {
      const before = panels(), turned = () => panels().map((now, i) => now !== before[i]);
      mouse(viewer, 'mousedown', 300);
      mouse(document, 'mousemove', 380);
      mouse(document, 'mouseup', 380);
      until(() => turned().every(Boolean), () => {
        for (const panel of turned()) say('panel ' + (panel ? 'turned' : 'still'));
        endLoading();
      });
    });
  )js",
                                    "", one_screen);
  expect_no_complaint(dom);
  EXPECT_EQ(count(dom, "<p class=\"said\">panel turned"), 3u);
  EXPECT_EQ(count(dom, "<p class=\"said\">panel still"), 0u);
}

TEST_F(FiguresInBrowser, PicturesShowEverySurfaceAndColouring) {
  const PngPage page = png_page(open_with("", "#png=0&only=shapes"));
  EXPECT_EQ(page.failed, std::vector<std::string>());
  std::set<std::string> names;
  for (const PngFile& f : page.files) {
    names.insert(f.name);
    EXPECT_GT(f.bytes.size(), 10'000u) << f.name;
  }
  std::set<std::string> expected;
  for (const char* view : {"nu0.25", "nu0.4", "smooth-nu0.4"})
    for (const char* colouring : {"displacement", "difference", "volume_change"})
      expected.insert(std::string("golec_2019-compress-shapes-") + colouring + "-" + view + ".png");
  EXPECT_EQ(names, expected);
}

TEST_F(FiguresInBrowser, PicturesShowThePartsOfTheErrors) {
  const PngPage page = png_page(open_with("", "#png=0&only=split"));
  EXPECT_EQ(page.failed, std::vector<std::string>());
  std::set<std::string> names;
  for (const PngFile& f : page.files) names.insert(f.name);
  const std::string stem = "golec_2019-compress-split-";
  EXPECT_EQ(names,
            (std::set<std::string>{stem + "volume_change-hybmss.png", stem + "volume_change-nu0.25.png",
                                   stem + "volume_change-nu0.4.png", stem + "edge-volume_change-hybmss-nu0.25.png",
                                   stem + "edge-volume_change-hybmss-nu0.4.png"}));
}

}  // namespace
}  // namespace springproof::figures_in_browser_test
