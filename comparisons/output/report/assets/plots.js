"use strict";
// Plots of stored numbers, drawn by Bokeh: choices, models on and off, views that zoom and move.
const Plots = (() => {
  const made = {};
  // One hover tool for each side of the point, so that models which agree are read off side by side.
  const SIDES = ["left", "right", "above", "below"];

  // The library, run once.
  let library;
  const withLibrary = () => (library ??= Rows.text("bokeh").then((textContent) => {
    Rows.run({ textContent });
    Bokeh.set_log_level("warn");
  }));

  // A plot is drawn once, when it is first asked for.
  const drawing = {};
  function draw(figure) {
    const { id } = figure;
    drawing[id] ??= Promise.all([Rows.read(id), withLibrary()]).then(([plot]) => make(plot, figure))
      .catch((error) => Rows.complain(figure, error));
    return drawing[id];
  }

  function make(plot, figure) {
    const canvas = figure.querySelector(".canvas");
    const box = new Bokeh.BoxZoomTool();
    const touch = matchMedia("(pointer: coarse)").matches;
    const drawn = Bokeh.Plotting.figure({
      x_axis_type: plot.x_scale, x_axis_label: plot.x_label, y_axis_label: plot.y_label,
      x_range: new Bokeh.Range1d({ start: 1, end: 2 }), y_range: new Bokeh.Range1d({ start: 1, end: 2 }),
      // Vectors, so that print is as sharp as the screen.
      output_backend: "svg", sizing_mode: "stretch_both", toolbar_location: null, tools: [],
      background_fill_color: null, border_fill_color: null, min_border_right: 12,
    });
    // All tools are there before the plot is drawn: Bokeh fails when several are added to a plot on the page.
    const hovers = SIDES.map((attachment) => new Bokeh.HoverTool({
      renderers: [], attachment, line_policy: "nearest", tooltips: [["model", "@name"], ["", "@hover"]],
    }));
    drawn.add_tools(box, ...hovers);
    // A finger scrolls the page past the plot; the buttons zoom.
    drawn.toolbar.active_drag = touch ? null : box;
    for (const axis of [...drawn.xaxes, ...drawn.yaxes]) {
      Object.assign(axis, {
        axis_label_text_font: "system-ui, sans-serif", axis_label_text_font_style: "normal", axis_label_text_font_size: "13px",
        major_label_text_font: "system-ui, sans-serif", major_label_text_font_size: "12px",
      });
    }
    // Zero error, or the line on which a model is where the reference is.
    const zero = plot.mark === "points" ? new Bokeh.Slope({ gradient: 1, y_intercept: 0, line_width: 1 })
      : new Bokeh.Span({ location: 0, dimension: "width", line_width: 1 });
    drawn.add_layout(zero);
    const one = { plot, figure, drawn, hovers, zero, layers: {}, dark: Theme.dark() };
    made[plot.id] = one;

    figure.querySelectorAll("select").forEach((control) => control.addEventListener("change", () => choose(one, true)));
    figure.querySelectorAll(".models input").forEach((control) => control.addEventListener("change", () => choose(one)));
    figure.querySelectorAll("[data-zoom]").forEach((button) => button.addEventListener("click", () => move(one, button.dataset.zoom)));
    choose(one, true);
    Theme.follow((dark) => paint(one, dark));
    return Bokeh.Plotting.show(drawn, canvas);
  }

  // Ink, soft ink, axes, minor ticks and grid of a light and of a dark page; and its paper.
  const LIGHT = ["#1b1f24", "#4d5661", "#87919c", "#c3cad1", "#e5e8eb"];
  const DARK = ["#e8ebee", "#b4bcc5", "#7d8792", "#4b545e", "#2b333c"];
  const paper = (dark) => (dark ? "#14181d" : "#ffffff");

  function paint(one, dark) {
    const { drawn, zero, layers } = one;
    const [ink, soft, axes, minor, grid] = dark ? DARK : LIGHT;
    for (const axis of [...drawn.xaxes, ...drawn.yaxes]) {
      axis.setv({
        axis_label_text_color: ink, major_label_text_color: soft, axis_line_color: axes, major_tick_line_color: axes,
        minor_tick_line_color: minor,
      });
    }
    for (const lines of [...drawn.xgrids, ...drawn.ygrids]) lines.setv({ grid_line_color: grid });
    zero.setv({ line_color: axes });
    drawn.setv({ outline_line_color: grid });
    // A layer has its colours from the start: a glyph that changes while it is pointed at has no data for a moment.
    if (one.dark === dark) return;
    one.dark = dark;
    for (const layer of Object.values(layers).flat()) tint(dark, layer);
  }

  function tint(dark, { series, renderers }) {
    const colour = DATA.model_styles[series.model][dark ? 1 : 0];
    for (const { glyph } of renderers) {
      if (glyph.type === "VArea") glyph.setv({ fill_color: { value: colour } });
      else glyph.setv({ line_color: { value: colour } });
      if (glyph.type === "Scatter") glyph.setv({ fill_color: { value: paper(dark) } });
    }
  }

  // The series of a choice, made when it is first shown: a sweep has hundreds.
  function layersOf(one, group) {
    if (group in one.layers) return one.layers[group];
    const { plot, drawn } = one;
    const layers = [];
    for (const series of plot.series.filter((any) => any.group === group)) {
      const [light, night, dash, marker, broad] = DATA.model_styles[series.model];
      const colour = one.dark ? night : light;
      const data = {
        x: series.x, y: series.y, low: series.low, high: series.high,
        hover: series.hover, name: series.x.map(() => series.label),
      };
      const source = new Bokeh.ColumnDataSource({ data });
      const renderers = [];
      if (series.low.some((low, index) => low < series.high[index])) {
        renderers.push(drawn.varea({ field: "x" }, { field: "low" }, { field: "high" }, { source, fill_color: colour, fill_alpha: 0.2 }));
      }
      const below = plot.mark === "line" && broad;
      if (plot.mark !== "points") {
        renderers.push(drawn.line({ field: "x" }, { field: "y" }, {
          source, line_color: colour, line_dash: dash, line_width: below ? 3.5 : 2, line_alpha: below ? 0.45 : 1,
        }));
      }
      if (plot.mark !== "line") {
        // A source of its own: pointing at a marker would take away the line and the band of the same source.
        renderers.push(drawn.scatter({ field: "x" }, { field: "y" }, {
          source: new Bokeh.ColumnDataSource({ data }), marker, size: 8, fill_color: paper(one.dark), line_color: colour, line_width: 1.3,
        }));
      }
      layers.push({ series, renderers });
    }
    return (one.layers[group] = layers);
  }

  // Models at first shown of a choice that has none of those switched on.
  const SHOWN_AT_FIRST = 5;

  function choose(one, other = false) {
    const group = Array.from(one.figure.querySelectorAll("select"), (select) => select.value).join("|");
    const chosen = layersOf(one, group);
    const boxes = Array.from(one.figure.querySelectorAll(".models input"));
    const present = boxes.filter((input) => chosen.some(({ series }) => series.model === input.value));
    if (other && !present.some((input) => input.checked)) for (const input of present.slice(0, SHOWN_AT_FIRST)) input.checked = true;
    const on = new Set(boxes.filter((input) => input.checked).map((input) => input.value));
    for (const layer of Object.values(one.layers).flat()) {
      const visible = layer.series.group === group && on.has(layer.series.model);
      for (const renderer of layer.renderers) renderer.visible = visible;
    }
    const here = new Set(chosen.map(({ series }) => series.model));
    for (const input of boxes) input.closest("label").hidden = !here.has(input.value);
    one.figure.querySelector(".empty").hidden = here.size > 0;
    const words = Array.from(one.figure.querySelectorAll(".choices label"), (label) =>
      `${label.firstChild.textContent.trim()}: ${label.querySelector("select").selectedOptions[0]?.textContent ?? ""}`);
    one.figure.querySelector(".choice").textContent = words.join(", ");
    Tables.choose(one.plot.table, group);
    const label = one.plot.y_labels[group] ?? one.plot.y_label;
    for (const axis of one.drawn.yaxes) axis.setv({ axis_label: label });
    const visible = chosen.filter(({ series }) => on.has(series.model));
    one.shown = visible.map(({ series }) => series);
    // What is pointed at: the nearest of a line's points, or a point itself.
    const pointed = visible.map(({ renderers }) => renderers.at(-1));
    one.hovers.forEach((hover, side) => {
      hover.renderers = pointed.filter((_, index) => index % SIDES.length === side);
    });
    if (one.shown.length) setView(one, one.plot.views[group] ?? whole(one));
  }

  // The view of everything that is visible, with a margin.
  function whole(one) {
    const { shown } = one;
    const span = (values, scale) => {
      const f = scale === "log" ? Math.log10 : Number;
      const finite = values.map(f).filter(Number.isFinite);
      let [low, high] = [Math.min(...finite), Math.max(...finite)];
      if (!(high > low)) [low, high] = [low - 0.5, high + 0.5];
      const margin = 0.06 * (high - low);
      return [low - margin, high + margin].map((v) => (scale === "log" ? 10 ** v : v));
    };
    const y = shown.flatMap((series) => [...series.low, ...series.high]);
    return [...span(shown.flatMap((series) => series.x), one.plot.x_scale), ...span(y, "linear")];
  }

  function setView(one, [x0, x1, y0, y1]) {
    one.drawn.x_range.setv({ start: x0, end: x1 });
    one.drawn.y_range.setv({ start: y0, end: y1 });
  }

  const STEPS = { in: [0, 0, 0.7], out: [0, 0, 1 / 0.7], left: [-0.2, 0, 1], right: [0.2, 0, 1], up: [0, 0.2, 1], down: [0, -0.2, 1] };

  function move(one, how) {
    if (how === "reset") return choose(one);
    if (how === "all") return setView(one, whole(one));
    const [dx, dy, factor] = STEPS[how];
    const { x_range, y_range } = one.drawn;
    return setView(one, [...shifted(x_range, one.plot.x_scale, dx, factor), ...shifted(y_range, "linear", dy, factor)]);
  }

  function shifted(range, scale, shift, factor) {
    const [there, back] = scale === "log" ? [Math.log10, (v) => 10 ** v] : [Number, Number];
    const [low, high] = [there(range.start), there(range.end)];
    const [middle, half] = [(low + high) / 2 + shift * (high - low), (factor * (high - low)) / 2];
    return [back(middle - half), back(middle + half)];
  }

  const figures = Array.from(document.querySelectorAll("figure.plot"));
  const all = () => Promise.all(figures.map(draw));
  // A reader who scrolls finds a plot drawn.
  const near = new IntersectionObserver((entries) => {
    for (const { isIntersecting, target } of entries) if (isIntersecting) draw(target);
  }, { rootMargin: "300px" });
  for (const figure of figures) near.observe(figure);
  // Paper has every plot.
  document.querySelector("#print")?.addEventListener("click", () => all().then(() => print()));

  // The visible part of both axes, for tests: Plots.range("plot-kappa").
  function range(id) {
    const { x_range, y_range } = made[id].drawn;
    return [x_range.start, x_range.end, y_range.start, y_range.end];
  }
  // Where the frame of a plot is in its box, in pixels: left, top, width, height.
  function inner(id) {
    const { bbox } = Bokeh.index.find_one_by_id(made[id].drawn.id).frame;
    return [bbox.left, bbox.top, bbox.width, bbox.height];
  }
  const dark = (id) => made[id].dark;
  return { all, range, inner, dark };
})();
