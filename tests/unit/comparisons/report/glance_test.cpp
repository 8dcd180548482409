// What the report says at first sight, on screens of three widths, light and dark, and with many case pages open.
#include "support/sample_case.h"
#include "unit/comparisons/report/report_page.h"

namespace springproof::glance_test {
namespace {

// ---- the sentence and the plot

/// Models whose displacement and reactions rank differently, and springs of one Poisson's ratio, closest there.
CaseResult disputed_case() {
  CaseResult c;
  c.experiment = sample_experiment();
  c.experiment.models = {{"near", {}, "near", {}}, {"even", {}, "even", {}}, {"msm_18", {}, "msm_18", {}}};
  c.experiment.measures = {"displacement_error", "reaction_error"};
  c.own_poisson_ratios["msm_18"] = 0.25;
  const auto add = [&](const char* model, double nu, double displacement, double reaction) {
    c.runs.push_back({{model, nu, {2, 2, 2}}, "msm", "linear", true, "", "CG", 9, 1e-9, 0.1, 81});
    for (const auto& [measure, error] : {std::pair("displacement_error", displacement), {"reaction_error", reaction}})
      c.rows.push_back({{model, nu, {2, 2, 2}}, "compress", "linear", measure, error, "1", 0.0, 1e-4, error});
  };
  for (double nu : {0.25, 0.4}) {
    add("near", nu, 0.01, 0.2);
    add("even", nu, 0.03, 0.04);
  }
  add("msm_18", 0.25, 0.001, 0.001);
  return c;
}

class Glance : public Report {};
class GlanceInBrowser : public ReportInBrowser {};

TEST_F(GlanceInBrowser, ThePlotRanksAsTheAnswerDoes) {
  const std::string dom = open_with({disputed_case()}, pictures({}), tools + R"js(
    const texts = selector => [...document.querySelectorAll(selector)].map(node => node.textContent).join('; ');
    say('answer ' + document.querySelector('.answer').textContent);
    say('head ' + texts('.dot-head b, .dot-head output'));
    say('lines ' + texts('.dot-name') + ' with ' + texts('.dot-worst'));
    say('closest ' + texts('.dot-name.closest'));
    say('dots ' + [...document.querySelectorAll('.dot')].map(dot => dot.title).join('; '));
    endLoading();
  )js");
  expect_no_complaint(dom);
  EXPECT_NE(dom.find("answer Of the spring models even comes closest: its displacements and the reactions of moved "
                     "supports are within 4&nbsp;% of finite elements (uncertain by 0.01&nbsp;%) for ν from 0.25 to "
                     "0.4, in 1 linear case."),
            std::string::npos)
      << said(dom);
  EXPECT_NE(
      dom.find("head Largest error of displacement and reactions against finite elements; for ν from 0.25 to 0.4"),
      std::string::npos)
      << said(dom);
  EXPECT_NE(dom.find("lines even; near; msm_18 ν = 0.25 with 4.0 %; 20 %; 0.10 %<"), std::string::npos) << said(dom);
  EXPECT_NE(dom.find("closest even<"), std::string::npos) << said(dom);
  EXPECT_NE(dom.find("near, compress: 20 % (reactions) at ν = 0.25"), std::string::npos) << said(dom);
}

TEST_F(GlanceInBrowser, ThePlotNamesWhatWasCompared) {
  CaseResult c = disputed_case();
  std::erase_if(c.rows, [](const auto& row) { return row.measure == "displacement_error"; });
  c.experiment.measures = {"reaction_error"};
  const std::string dom = open_with({c}, pictures({}), tools + R"js(
    say('head ' + document.querySelector('.dot-head b').textContent);
    say('outcome ' + outcome(cases[0]).textContent);
    endLoading();
  )js");
  expect_no_complaint(dom);
  EXPECT_NE(dom.find("head Largest error of the reactions of moved supports against finite elements"),
            std::string::npos)
      << said(dom);
  EXPECT_NE(dom.find("Largest errors of reactions: "), std::string::npos) << said(dom);
}

TEST_F(GlanceInBrowser, LargeDeformationAloneIsPlottedToo) {
  CaseResult large = disputed_case();
  large.experiment.kinematics = "hencky";
  const std::string dom = open_with({large}, pictures({}), tools + R"js(
    say('lines ' + [...document.querySelectorAll('.dot-name')].map(node => node.textContent).join('; '));
    say('facts ' + document.querySelector('#first-facts').textContent);
    endLoading();
  )js");
  expect_no_complaint(dom);
  EXPECT_NE(dom.find("lines even; near; msm_18 ν = 0.25<"), std::string::npos) << said(dom);
  EXPECT_NE(dom.find("facts Displacement of evencompress 3.0"), std::string::npos) << said(dom);
}

TEST_F(GlanceInBrowser, MotionsAreComparedInTime) {
  CaseResult c;
  c.experiment = sample_experiment();
  c.experiment.kinematics = "hencky";
  c.experiment.models.clear();
  c.experiment.measures = {"displacement_error", "motion_error"};
  for (const auto& [model, error] : {std::pair("emsm", 0.12), {"hybmss", 0.04}}) {
    const std::string label = std::string(model) + " in motion";
    c.experiment.models.push_back({model, {}, label, {}, {}, true});
    c.runs.push_back({{label, 0.3, {2, 2, 2}}, "msm", "finite", true, "", "explicit", 9, 0, 0.1, 81});
    c.rows.push_back({{label, 0.3, {2, 2, 2}}, "compress", "finite", "motion_error", error, "1", 0.0, 0.01, error});
    HistoryRecord& history = c.histories.emplace_back();
    static_cast<RunKey&>(history) = {label, 0.3, {2, 2, 2}};
    history.names = {"kinetic_energy", history.probe = "displacement.tip.z"};
    history.units = {"J", "m"};
    history.time = {0, 0.5, 1};
    history.values = {{0, 1, 0}, {0, error, 0}};
  }
  const std::string dom = open_with({c}, pictures({}), tools + R"js(
    say('curve ' + document.querySelector('#first-bodies b').textContent);
    say('head ' + document.querySelector('.dot-head b').textContent);
    say('dots ' + [...document.querySelectorAll('.dot')].map(dot => dot.title).join('; '));
    say('closest ' + document.querySelector('.dot-name.closest').textContent);
    say('facts ' + document.querySelector('#first-facts').textContent);
    say('row ' + [...document.querySelectorAll('#cases tbody td')].slice(3).map(cell => cell.textContent).join('; '));
    const canvas = document.querySelector('#first-bodies canvas');
    until(() => drawn(canvas), () => { say(drawn(canvas) ? 'drawn' : 'blank'); endLoading(); });
  )js");
  expect_no_complaint(dom);
  EXPECT_NE(dom.find("curve compress: displacement.tip.z in time, ν = 0.3"), std::string::npos) << said(dom);
  EXPECT_NE(dom.find("<p class=\"said\">drawn"), std::string::npos) << said(dom);
  EXPECT_NE(dom.find("head Largest difference of motions against finite elements"), std::string::npos) << said(dom);
  EXPECT_NE(dom.find("dots hybmss in motion, compress: 4.0 % at ν = 0.3; emsm in motion, compress: 12 % at ν = 0.3<"),
            std::string::npos)
      << said(dom);
  EXPECT_NE(dom.find("closest hybmss in motion<"), std::string::npos) << said(dom);
  EXPECT_NE(dom.find("facts Motion of hybmsscompress 4.0"), std::string::npos) << said(dom);
  EXPECT_NE(dom.find("row ± 1.0 %; 4.0 %ν = 0.3; 12 %ν = 0.3"), std::string::npos) << said(dom);
}

TEST_F(GlanceInBrowser, LostEquilibriaAreACurve) {
  CaseResult c;
  c.experiment = sample_experiment();
  c.experiment.kinematics = "hencky";
  c.experiment.models = {{"hybmss", {}, "hybmss", {}}, {"hybmss_avg", {}, "hybmss_avg", {}}};
  for (const auto& [model, nu, load] :
       {std::tuple("hybmss", 0.0, 0.75), {"hybmss", 0.4, 1.0}, {"hybmss_avg", 0.0, 1.0}}) {
    const Stability stability{load, load < 1 ? "unstable" : "", 0.2, 0.1, {}, 0.05};
    c.runs.push_back({{model, nu, {2, 2, 2}}, "msm", "finite", load == 1, "", "", 1, 0, 0, 0, 0, 0, stability});
  }
  const std::string dom = open_with({c}, pictures({}), tools + R"js(
    const chart = canvas => Chart.getChart(canvas).data.datasets.map(d => `${d.label} ${d.data.map(p => p.x + ': ' + p.y).join(', ')}`).join('; ');
    say('curve ' + document.querySelector('#first-bodies b').textContent);
    for (const at of ['#first-bodies', '#stability']) say(at + ' ' + chart(document.querySelector(at + ' canvas')));
    endLoading();
  )js");
  expect_no_complaint(dom);
  EXPECT_NE(dom.find("curve compress: share of the load up to which equilibria are stable"), std::string::npos)
      << said(dom);
  for (const std::string at : {"#first-bodies", "#stability"})
    EXPECT_NE(dom.find(at + " hybmss 0: 75, 0.4: 100; hybmss_avg 0: 100, 0.4: null"), std::string::npos) << said(dom);
}

// ---- warnings

/// Too much strain for linear theory, and a reference of 7 %.
CaseResult doubtful_case(const std::string& name = "compress") {
  CaseResult c = sample_case();
  c.experiment.name = name;
  c.deformations = {{0.25, 0.02, 3.5}, {0.4, 0.08, 4.5}};
  c.references.push_back({0.4, "displacement_error", "1", {}, {}, 1.5, 0, 0.07, "Richardson"});
  return c;
}

TEST_F(Glance, WarningsFollowTheAnswerAndTheFacts) {
  const std::string page = write({sample_case(), doubtful_case()});
  const auto answer = page.find("<p class=\"answer\">hybmss: its displacements are within"),
             doubt = page.find("<a class=\"amber\" data-case=\"1\">The reference is not sharp (compress at ν = 0.4)"),
             facts = page.find("<dl id=\"first-facts\">"),
             warning = page.find(
                 "<a class=\"amber\" data-case=\"1\">compress: principal strains of 8\u00a0% are too large for "
                 "linear theory (up to 5\u00a0%)</a>");
  EXPECT_TRUE(answer < doubt && doubt < facts && facts < warning && warning != std::string::npos)
      << page.substr(page.find("<div class=\"first\">"), 2000);
}

TEST_F(Glance, ManyWarningsAreFolded) {
  const std::vector<CaseResult> three(3, doubtful_case()), four(4, doubtful_case());
  EXPECT_EQ(write(three).find(" notes and warnings</summary>"), std::string::npos);
  EXPECT_NE(write(four).find("<summary>4 notes and warnings</summary>"), std::string::npos);
}

TEST_F(GlanceInBrowser, AWarningLeadsToItsCase) {
  const std::string dom = open_with({sample_case(), doubtful_case("squeeze")}, pictures({}), tools + R"js(
    document.querySelector('.warnings a').click();
    const page = document.getElementById('case-golec_2019-squeeze'), text = () => page.querySelector('.amber');
    until(() => page.open && text(), () => {
      say((page.open ? 'open: ' : 'closed: ') + text().textContent);
      endLoading();
    });
  )js");
  expect_no_complaint(dom);
  EXPECT_NE(dom.find("open: squeeze: principal strains of 8 % are too large for linear theory (up to 5 %); divide the "
                     "load by at least 1.6, or set"),
            std::string::npos)
      << said(dom);
}

// ---- many bodies

TEST_F(GlanceInBrowser, ManyCasePagesShareOneContext) {
  std::vector<CaseResult> cases(18, sample_case());  // browsers allow 16 contexts
  for (std::size_t i = 0; i < cases.size(); ++i) cases[i].experiment.name = "case" + std::to_string(i);
  const std::string dom = open_with(cases, pictures(cases), tools + R"js(
    const pages = [...document.querySelectorAll('details.case')];
    const canvasOf = page => page.querySelector('.viewer canvas');
    /// Opens a page and goes there; on with the next when it is drawn.
    const visit = i => {
      if (i === pages.length) return back();
      pages[i].open = true;
      pages[i].fill();
      pages[i].scrollIntoView({behavior: 'instant'});
      until(() => drawn(canvasOf(pages[i])), () => visit(i + 1));
    };
    const turn = (page, then, patience) => {
      const canvas = canvasOf(page), before = pixelsOf(canvas).join();
      page.querySelector('.viewer').dispatchEvent(new KeyboardEvent('keydown', {key: 'ArrowLeft', bubbles: true}));
      until(() => pixelsOf(canvas).join() !== before, () => then(drawn(canvas) && pixelsOf(canvas).join() !== before ? 'turned' : 'still'), patience);
    };
    const back = () => {
      say(`drawn ${pages.map(canvasOf).filter(drawn).length} of ${pages.length}`);
      pages[0].scrollIntoView({behavior: 'instant'});
      turn(pages[0], word => { say('first ' + word); lose(); });
    };
    const lose = () => {
      const gl = webGL().getContext(), handle = gl.getExtension('WEBGL_lose_context');
      handle.loseContext();
      until(() => gl.isContextLost(), () => turn(pages[0], word => {
        say(`lost: ${word}, ${drawn(canvasOf(pages[0])) ? 'still there' : 'blank'}`);
        handle.restoreContext();
        until(() => !gl.isContextLost(), () => turn(pages[0], word => { say('restored: ' + word); endLoading(); }));
      }, 20));
    };
    visit(0);
  )js",
                                    "", one_screen);
  EXPECT_EQ(dom.find("Too many active WebGL contexts"), std::string::npos);
  EXPECT_NE(dom.find("drawn 18 of 18"), std::string::npos) << said(dom);
  EXPECT_NE(dom.find("first turned"), std::string::npos) << said(dom);
  EXPECT_NE(dom.find("lost: still, still there"), std::string::npos) << said(dom);
  EXPECT_NE(dom.find("restored: turned"), std::string::npos) << said(dom);
}

// ---- screens

/// Goes down the page in its frame and tells the frame's parent what it found.
const std::string inspection = R"js(
  const tell = text => parent.postMessage(`${innerWidth} ${matchMedia('(prefers-color-scheme: dark)').matches ? 'dark' : 'light'}: ${text}`, '*');
  window.addEventListener('error', event => tell('error ' + event.message));
  const seen = node => node.checkVisibility() && node.getBoundingClientRect().width > 0;

  /// Red, green, blue, alpha of a colour of the style sheet.
  const rgba = color => { const [r, g, b, a = 1] = color.match(/[\d.]+/g).map(Number); return [r, g, b, a]; };
  const over = ([r, g, b, a], below) => [r, g, b].map((c, i) => a * c + (1 - a) * below[i]);
  /// What is behind a node: the colours of its ancestors, one over the other.
  const behind = node => {
    if (!node) return rgba(getComputedStyle(document.documentElement).getPropertyValue('--paper').replace(/^#(..)(..)(..)$/,
      (_, ...hex) => hex.slice(0, 3).map(x => parseInt(x, 16)).join(' ')));
    const color = rgba(getComputedStyle(node).backgroundColor);
    return color[3] === 1 ? color : over(color, behind(node.parentElement));
  };
  const luminance = color => [0.2126, 0.7152, 0.0722].reduce((sum, weight, i) => {
    const c = color[i] / 255;
    return sum + weight * (c <= 0.04045 ? c / 12.92 : ((c + 0.055) / 1.055) ** 2.4);
  }, 0);
  const contrast = node => {
    const back = behind(node), levels = [back, over(rgba(getComputedStyle(node).color), back)].map(luminance).sort((a, b) => a - b);
    return (levels[1] + 0.05) / (levels[0] + 0.05);
  };
  /// Elements with text of their own that can be seen; glyphs that stand for dots are pictures.
  const written = () => [...document.body.querySelectorAll('*')].filter(node => seen(node) && !node.closest('[role=img]') &&
    [...node.childNodes].some(child => child.nodeType === Node.TEXT_NODE && child.textContent.trim()));

  const named = node => node.getAttribute('aria-label') || node.title || node.textContent.trim() || node.closest('label')?.textContent.trim();
  const words = node => (node.closest('section, header').id + ' ' + (node.getAttribute('aria-label') || node.textContent)).trim().slice(0, 60);

  function inspect() {
    tell(`overflow ${Math.max(0, document.documentElement.scrollWidth - document.documentElement.clientWidth)}`);
    tell('faint ' + written().map(node => [contrast(node), node]).filter(([ratio]) => ratio < 4.5)
      .map(([ratio, node]) => `${ratio.toFixed(2)} in ${words(node)}`).join(' | '));
    const stops = [...document.querySelectorAll('a[href], button, input, select, summary, [tabindex]')].filter(seen);
    tell('out of order ' + stops.filter(node => node.tabIndex !== 0).map(words).join(' | '));
    tell('nameless ' + stops.filter(node => !named(node)).map(words).join(' | '));
    const canvases = [...document.querySelectorAll('canvas')].filter(seen);
    tell('without text ' + canvases.filter(canvas => canvas.getAttribute('role') !== 'img' || !canvas.getAttribute('aria-label') ||
      canvas.closest('[aria-hidden=true]')).map(words).join(' | '));
    tell(`canvases ${canvases.length}`);
    look(canvases, []);
  }

  /// Goes from canvas to canvas, waiting until each is drawn.
  function look([canvas, ...others], blank) {
    if (!canvas) return finish(blank);
    const there = () => {
      if (drawn(canvas)) return true;
      canvas.scrollIntoView({behavior: 'instant', block: 'center'});  // again: what was opened above pushes it away
    };
    until(there, () => look(others, drawn(canvas) ? blank : [...blank, canvas]));
  }

  /// The first screen again, for the picture of it.
  function finish(blank) {
    for (const page of document.querySelectorAll('details')) page.open = false;
    scrollTo({top: 0, behavior: 'instant'});
    tell('blank ' + blank.map(words).join(' | '));
    endLoading();
  }

  const first = () => document.querySelector('#first-bodies canvas');
  until(() => first() && drawn(first()), () => {
    const answer = document.querySelector('.answer').getBoundingClientRect(), bodies = [...document.querySelectorAll('#first-bodies .panel')];
    tell(`answer ${answer.top >= 0 && answer.bottom <= innerHeight && answer.right <= innerWidth ? 'on' : 'off'} the first screen`);
    tell(`bodies ${bodies.filter(body => body.getBoundingClientRect().bottom <= innerHeight).length} on the first screen`);
    for (const details of document.querySelectorAll('details')) { details.open = true; if (details.fill) details.fill(); }
    setTimeout(inspect, 300);
  });
)js";

class Screens : public ReportInBrowser, public testing::WithParamInterface<const char*> {
 protected:
  /// What is said of the report in frames of three widths; they are also kept as a picture in the build's folder.
  std::string inspected(const std::string& scheme) {
    const std::filesystem::path frames = file.string() + ".frames.html";
    std::ofstream out(frames);
    out << "<!DOCTYPE html><body style=\"margin: 0\"><div style=\"display: flex; align-items: start; gap: 8px\">";
    for (const auto& [width, height] : {std::pair(1400, 900), {768, 1024}, {390, 844}})
      out << "<iframe src=\"" << file.filename().string() << "\" style=\"border: 0; flex: none; width: " << width
          << "px; height: " << height << "px\"></iframe>";
    out << "</div><script>" << tools << R"js(
      let ended = 0;
      addEventListener('message', event => { say(event.data); if (event.data.includes(': blank ') && ++ended === 3) setTimeout(endLoading, 500); });
    )js"
        << "</script></body></html>";
    out.close();
    const auto shots = std::filesystem::path(SPRINGPROOF_BINARY_DIR) / "screenshots";
    std::filesystem::create_directories(shots);
    const std::string dom = visit(frames, "",
                                  "--window-size=2600,1200 --hide-scrollbars --blink-settings=preferredColorScheme=" +
                                      std::string(scheme == "dark" ? "0" : "1") + " --screenshot='" +
                                      (shots / ("report-" + scheme + ".png")).string() + "'");
    std::filesystem::remove(frames);
    return dom;
  }
};

TEST_P(Screens, TheReportIsReadable) {
  const std::string scheme = GetParam();
  write({sample_case(), doubtful_case("squeeze")});
  add_script(tools + inspection);
  const std::string dom = inspected(scheme);
  EXPECT_EQ(dom.find(":CONSOLE"), std::string::npos) << dom.substr(dom.find(":CONSOLE"), 300);
  std::vector<std::string> expected = {"1400 " + scheme + ": bodies 2 on the first screen"}, missing;
  for (const char* width : {"1400", "768", "390"})
    for (const char* finding : {"answer on the first screen", "overflow 0", "faint ", "out of order ", "nameless ",
                                "without text ", "canvases 7", "blank "})
      expected.push_back(std::string(width) + " " + scheme + ": " + finding);
  for (const std::string& finding : expected)
    if (dom.find(">" + finding + "<") == std::string::npos) missing.push_back(finding);
  EXPECT_EQ(missing, std::vector<std::string>()) << said(dom);
}
INSTANTIATE_TEST_SUITE_P(Schemes, Screens, testing::Values("light", "dark"),
                         [](const auto& i) { return std::string(i.param); });

}  // namespace
}  // namespace springproof::glance_test
