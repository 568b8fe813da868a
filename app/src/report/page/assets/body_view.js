// A meshed body in 3D: every figure.body-view has its surface as JSON. WebGL draws it, or without it the painter's
// algorithm. Contacts, axes and the scale are SVG over the canvas.
(() => {
  "use strict";
  const BODY = [178, 188, 198], FIXED = [176, 38, 140], LINE = [38, 44, 50], PALE = [150, 158, 166], LIGHT = [-0.36, 0.62, 0.7];
  const CREASE = Math.cos((40 * Math.PI) / 180), ISOMETRIC = Math.atan(Math.SQRT1_2), BEND = 0.05, PERIOD = 2500, ARROW = 0.2, MAX_TIP = 0.6;
  const decode = (text, Type) => new Type(Uint8Array.from(atob(text), (c) => c.charCodeAt(0)).buffer);
  const dot = (a, b) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
  const cross = (a, b) => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
  const along = (a, s, b) => [a[0] + s * b[0], a[1] + s * b[1], a[2] + s * b[2]];
  const normalOf = ([a, b, c]) => cross(along(b, -1, a), along(c, -1, a));
  const within = (low, value, high) => Math.min(Math.max(value, low), high);
  const number = (value) => String(+value.toPrecision(3)).replace("-", "−");
  // cividis as in the other drawings: polynomials of d3-scale-chromatic
  const CIVIDIS = [[-4.54, 32.49, 81.24], [-35.34, 170.73, 442.36], [2381.73, 52.82, -2482.43], [-6402.7, -131.46, 6167.24], [7024.72, 176.58, -6614.94], [-2710.57, -67.37, 2475.67]];
  const MAP = Array.from({ length: 64 }, (_, k) => CIVIDIS.reduceRight((sum, c) => along(c, k / 63, sum), [0, 0, 0]).map((c) => within(0, Math.round(c), 255)));

  // the surface in units of its largest extent, from the corner of its box
  function surfaceOf(data) {
    const points = Float32Array.from(decode(data.points, Uint16Array), (q) => q / 65535), faces = decode(data.triangles, Uint32Array);
    const nodes = data.nodes_per_triangle ?? 3, [parts, sides] = nodes === 6
      ? [[0, 3, 5, 3, 1, 4, 5, 4, 2, 3, 4, 5], [0, 3, 3, 1, 1, 4, 4, 2, 2, 5, 5, 0]] : [[0, 1, 2], [0, 1, 1, 2, 2, 0]];
    const taken = (pattern) => Uint32Array.from({ length: (faces.length / nodes) * pattern.length }, (_, k) =>
      faces[nodes * Math.floor(k / pattern.length) + pattern[k % pattern.length]]);
    const triangles = taken(parts), fixed = Float32Array.from(decode(data.fixed, Uint8Array)), held = new Set();
    for (let t = 0; t < triangles.length; t += 3) {
      const corners = triangles.subarray(t, t + 3);
      if (corners.every((node) => fixed[node])) corners.forEach((node) => held.add(node));
    }
    return {
      points, triangles, fixed, places: Array.from(fixed, (_, k) => [...points.subarray(3 * k, 3 * k + 3)]), edges: decode(data.edges, Uint32Array), mesh: taken(sides),
      // fixed nodes without a fixed triangle
      loose: Uint32Array.from(fixed.keys()).filter((node) => fixed[node] && !held.has(node)),
    };
  }

  // normals at the corners of the triangles: means of those around a node that differ by less than a crease
  function normalsOf({ places, triangles }) {
    const areas = [], units = [], around = places.map(() => []), normals = new Float32Array(3 * triangles.length);
    for (let t = 0; t < triangles.length; t += 3) {
      const corners = [...triangles.subarray(t, t + 3)], area = normalOf(corners.map((node) => places[node])), size = Math.hypot(...area) || 1;
      for (const node of corners) around[node].push(areas.length);
      areas.push(area);
      units.push(area.map((x) => x / size));
    }
    triangles.forEach((node, corner) => {
      const alike = around[node].filter((t) => dot(units[t], units[Math.floor(corner / 3)]) > CREASE);
      normals.set(alike.reduce((sum, t) => along(sum, 1, areas[t]), [0, 0, 0]), 3 * corner);
    });
    return normals;
  }

  const VERTEX = `
    attribute vec3 place, normal, shape; attribute float value, held;
    uniform mat3 axes; uniform vec3 centre, shift; uniform vec2 zoom; uniform float bend;
    varying vec3 facing; varying float level, hatch;
    void main() {
      vec3 seen = axes * (place + bend * shape - centre);
      gl_Position = vec4(vec3(seen.xy * zoom, -0.2 * seen.z) + shift, 1.0);
      gl_PointSize = 9.0;
      facing = axes * normalize(normal);
      level = value; hatch = held;
    }`;
  const FRAGMENT = `
    precision highp float;
    varying vec3 facing; varying float level, hatch;
    uniform vec4 paint; uniform float lit, mapped, stripe;
    void main() {
      float t = min(floor(64.0 * level), 63.0) / 63.0, light = 0.5 + 0.5 * dot(normalize(facing), vec3(${LIGHT}));
      vec3 map = (${CIVIDIS.map((c) => `vec3(${c})`).reduceRight((sum, c) => `${c} + t * (${sum})`)}) / 255.0;
      float hatched = mod(gl_FragCoord.x + gl_FragCoord.y, stripe) < 0.36 * stripe ? 0.9 : 0.25 * (1.0 - mapped);
      vec3 base = mix(mix(paint.rgb, map, mapped), vec3(${FIXED}) / 255.0, hatch > 0.99 ? hatched : 0.0);
      gl_FragColor = lit < 0.5 ? vec4(paint.rgb * paint.a, paint.a) : vec4(base * mix(0.36 + 0.7 * light, 0.62 + 0.42 * light, mapped), 1.0);
    }`;

  // draws with WebGL; null where there is none
  function webgl(canvas, surface) {
    const gl = canvas.getContext("webgl", { preserveDrawingBuffer: true });
    if (!gl) return null;
    const program = gl.createProgram(), normals = normalsOf(surface), kept = new Map();
    for (const [type, source] of [[gl.VERTEX_SHADER, VERTEX], [gl.FRAGMENT_SHADER, FRAGMENT]]) {
      const shader = gl.createShader(type);
      gl.shaderSource(shader, source);
      gl.compileShader(shader);
      gl.attachShader(program, shader);
    }
    gl.linkProgram(program);
    gl.useProgram(program);
    gl.enable(gl.DEPTH_TEST);
    gl.enable(gl.BLEND);
    gl.blendFunc(gl.ONE, gl.ONE_MINUS_SRC_ALPHA);
    const uniform = (name) => gl.getUniformLocation(program, name), set = (name, ...values) => gl[`uniform${values.length}f`](uniform(name), ...values);
    // values of corners, or of nodes for each corner or end; buffers are filled when first shown
    const attribute = (name, width, values, nodes) => {
      const place = gl.getAttribLocation(program, name);
      if (!values) return gl.disableVertexAttribArray(place);
      const buffers = kept.get(values) ?? kept.set(values, new Map()).get(values), known = buffers.get(nodes), buffer = known ?? gl.createBuffer();
      gl.bindBuffer(gl.ARRAY_BUFFER, buffer);
      if (!known) gl.bufferData(gl.ARRAY_BUFFER, nodes ? Float32Array.from({ length: width * nodes.length }, (_, k) => values[width * nodes[Math.floor(k / width)] + (k % width)]) : values, gl.STATIC_DRAW);
      buffers.set(nodes, buffer);
      gl.enableVertexAttribArray(place);
      gl.vertexAttribPointer(place, width, gl.FLOAT, false, 0, 0);
    };
    return (view) => {
      const { field, bend } = view, ink = field ? PALE : LINE;
      gl.viewport(0, 0, canvas.width, canvas.height);
      gl.clear(gl.COLOR_BUFFER_BIT | gl.DEPTH_BUFFER_BIT);
      gl.uniformMatrix3fv(uniform("axes"), false, [0, 1, 2].flatMap((k) => view.rows.map((row) => row[k])));
      set("centre", ...view.centre);
      set("zoom", (2 * view.scale) / view.width, (2 * view.scale) / view.height);
      set("stripe", 9 * view.ratio);
      set("mapped", !!field);
      const draw = (mode, nodes, rgb, alpha, bent, moved = [[0, 0]]) => {
        const lit = mode === gl.TRIANGLES;
        attribute("place", 3, surface.points, nodes);
        attribute("shape", 3, field?.shape, nodes);
        attribute("value", 1, lit && field?.values, nodes);
        attribute("normal", 3, lit && normals);
        attribute("held", 1, lit && surface.fixed, nodes);
        set("lit", lit);
        set("bend", bent);
        set("paint", ...rgb.map((c) => c / 255), alpha);
        for (const [x, y] of moved) {
          set("shift", x / view.width, y / view.height, lit ? 0 : -0.001);
          gl.drawArrays(mode, 0, nodes.length);
        }
      };
      draw(gl.TRIANGLES, surface.triangles, BODY, 1, bend);
      if (view.mesh) draw(gl.LINES, surface.mesh, ink, 0.5, bend);
      if (bend) draw(gl.LINES, surface.edges, PALE, 0.6, 0);
      // a line is one pixel wide, four of them are two
      draw(gl.LINES, surface.edges, ink, 1, bend, [[-0.5, 0], [0.5, 0], [0, -0.5], [0, 0.5]]);
      draw(gl.POINTS, surface.loose, FIXED, 1, bend);
    };
  }

  // the same without WebGL: triangles that face the viewer, and lines, from the farthest
  function painter(canvas, { places, triangles, fixed, edges, mesh, loose }) {
    const context = canvas.getContext("2d");
    return ({ project, ratio, scale, field, bend, mesh: isMesh }) => {
      const items = [], seen = places.map((place, k) => {
        const [x, y, z] = project(bend ? along(place, bend, field.shape.subarray(3 * k)) : place);
        return [x, -y, z * scale];
      });
      const mean = (nodes, of) => nodes.reduce((sum, node) => sum + of(node), 0) / nodes.length;
      const add = (nodes, rgb, width, nearer) => items.push({ nodes, rgb, width, far: nearer + mean(nodes, (node) => seen[node][2]) });
      for (let t = 0; t < triangles.length; t += 3) {
        const nodes = [...triangles.subarray(t, t + 3)], normal = normalOf(nodes.map((node) => seen[node]));
        if (!(normal[2] > 0)) continue;
        const light = 0.5 + (0.5 * dot(normal, LIGHT)) / Math.hypot(...normal), bright = field ? 0.62 + 0.42 * light : 0.36 + 0.7 * light;
        const rgb = field ? MAP[Math.min(Math.floor(64 * mean(nodes, (node) => field.values[node])), 63)] : BODY;
        add(nodes, rgb.map((c, k) => bright * (nodes.every((node) => fixed[node]) ? 0.45 * c + 0.55 * FIXED[k] : c)), 0.7, 0);
      }
      for (const [list, step, rgb, width] of [[edges, 2, field ? PALE : LINE, 1.2], [loose, 1, FIXED, 5], [isMesh ? mesh : [], 2, PALE, 0.5]]) {
        for (let k = 0; k < list.length; k += step) add([...list.subarray(k, k + step)], rgb, width, 0.01 * scale);
      }
      context.setTransform(ratio, 0, 0, ratio, 0, 0);
      context.clearRect(0, 0, canvas.width, canvas.height);
      context.lineJoin = context.lineCap = "round";
      for (const { nodes, rgb, width } of items.sort((a, b) => a.far - b.far)) {
        context.beginPath();
        for (const node of nodes) context.lineTo(seen[node][0], -seen[node][1]);
        // back to the first; a single node is a dot
        context.lineTo(seen[nodes[0]][0] + 0.01, -seen[nodes[0]][1]);
        context.fillStyle = context.strokeStyle = `rgb(${rgb.map(Math.round)})`;
        context.lineWidth = width;
        context.fill();
        context.stroke();
      }
    };
  }

  // a contact: sphere of the tip and arrow of the force on the body, and its name
  function contactDrawn({ name, place, normal, radius }, { project, scale, rows }) {
    const tip = project(place), tail = project(along(place, Math.min(ARROW, 100 / scale), normal)), ball = project(along(place, radius, normal));
    const long = Math.hypot(tail[0] - tip[0], tail[1] - tip[1]), [x, y] = [0, 1].map((k) => (tip[k] - tail[k]) / (long || 1)), isArrow = long > 14, hidden = dot(normal, rows[2]) < -1e-9;
    const back = (s, side = 0) => `${tip[0] - s * x - side * y} ${tip[1] - s * y + side * x}`;
    const arrow = isArrow ? `<path class="halo" d="M${back(long)}L${back(0)}"/><path d="M${back(long)}L${back(8)}"/><path class="head" d="M${back(0)}L${back(11, 4.5)}L${back(11, -4.5)}z"/>` : "";
    const sphere = radius <= MAX_TIP ? `<circle class="tip" cx="${ball[0]}" cy="${ball[1]}" r="${radius * scale}"/>` : "";
    const [a, b] = isArrow ? [tail[0] - 22 * x, tail[1] - 12 * y] : [tip[0], tip[1] - 16], text = hidden && !isArrow ? "" : `<text x="${a}" y="${b}">${name}</text>`;
    return `<g class="contact"><g${hidden ? ' class="hidden"' : ""}>${sphere}${arrow}<circle cx="${tip[0]}" cy="${tip[1]}" r="3.6"/></g>${text}</g>`;
  }

  // the axes of the file, and a round length of at most a quarter of the width
  function scaleDrawn({ rows, width, height, scale }, size, perMetre, unit) {
    const axes = ["x", "y", "z"].map((name, k) => {
      const [x, y] = [rows[0][k], -rows[1][k]], text = `<text x="${34 + 27 * x}" y="${height - 34 + 27 * y}">${name}</text>`;
      return Math.hypot(x, y) < 0.1 ? "" : `<path d="M34 ${height - 34}l${18 * x} ${18 * y}"/>${text}`;
    });
    const most = (0.25 * width * size) / scale, decade = 10 ** Math.floor(Math.log10(most));
    const metres = decade * [5, 2, 1].find((step) => step * decade <= most), bar = (metres / size) * scale;
    return `${axes.join("")}<path d="M${width - 14} ${height - 19}v5h${-bar}v-5"/><text x="${width - 14 - bar / 2}" y="${height - 27}">${number(metres * perMetre)} ${unit}</text>`;
  }

  function show(figure) {
    const data = JSON.parse(figure.querySelector("script").textContent), surface = surfaceOf(data), { low, size } = data;
    const shares = (text, Type, most) => text && Float32Array.from(decode(text, Type), (q) => q / most);
    const fields = data.fields.map((field) => ({ ...field, values: shares(field.values, Uint8Array, 255), shape: shares(field.shape, Int8Array, 127) }));
    const contacts = data.contacts.map((contact) => ({ ...contact, radius: (contact.radius || Infinity) / size, place: contact.point.map((x, k) => (x - low[k]) / size) }));
    const [perMetre, unit] = size < 2e-3 ? [1e6, "µm"] : [1e3, "mm"], decimals = Math.max(4 - Math.ceil(Math.log10(size * perMetre)), 0);
    const lengths = (metres, between) => `${metres.map((x) => +(x * perMetre).toFixed(decimals)).join(between).replaceAll("-", "−")} ${unit}`;
    const extent = `${lengths([0, 1, 2].map((k) => size * surface.places.reduce((most, place) => Math.max(most, place[k]), 0)), " × ")} (x, y, z)`;
    const isFixed = surface.fixed.includes(1), key = (sign, words) => `<li><span>${sign}</span>${words}</li>`;
    figure.insertAdjacentHTML("afterbegin", `
      <div class="body-view-controls" role="group" aria-label="View of the body">
        <label>Show <select><option value="-1">geometry</option></select></label><button type="button"></button><label><input type="checkbox"> mesh</label>
        <span>${["top", "side", "bottom", "+", "−", "reset"].map((act) => `<button type="button">${act}</button>`).join("")}</span>
      </div>
      <div class="body-view-frame"><canvas tabindex="0" role="img"></canvas><svg aria-hidden="true"></svg></div>
      <div class="body-view-scale"><div></div><div style="background:linear-gradient(to right,${MAP.map((c) => `rgb(${c})`)})"></div><div></div></div>
      <ul class="legend">${isFixed ? key("", "fixed") : "<li>nothing is fixed</li>"}${key("→", "contact point, force on the body")}
        ${contacts.some(({ radius }) => radius <= MAX_TIP) ? key("◌", "sphere of the tip radius") : ""}<li>${extent}</li></ul>
      <p class="note soft"><span>Drag or arrow keys turn the body, Shift and drag moves it. + and − zoom, after a click the wheel too. A double click resets.</span>
        <span>One finger turns the body: sideways, every way after a tap. Two fingers zoom. A double tap resets.</span></p>`);
    const [canvas, svg, select, play, mesh, bar] = ["canvas", "svg", "select", "button", "input", ".body-view-scale"].map((name) => figure.querySelector(name));
    select.append(...fields.map(({ name }, k) => new Option(name, k)));
    canvas.ariaLabel = `Body in 3D, ${extent}. ${contacts.map(({ name, point }) => `The ${name} contact is at ${lengths(point, ", ")}. `).join("")}${
      isFixed ? "Fixed faces are hatched" : "Nothing is fixed"}. Arrow keys turn the body, plus and minus zoom, 0 resets.`;

    // the axis that is nearest to the outer contact's normal is up, z in doubt
    const outward = contacts[0].normal, axis = [2, 0, 1].reduce((best, k) => (Math.abs(outward[k]) > Math.abs(outward[best]) + 1e-3 ? k : best));
    const [up, side] = [[axis, Math.sign(outward[axis])], [(axis + 1) % 3, 1]].map(([k, sign]) => [0, 1, 2].map((other) => (other === k ? sign : 0)));
    const view = { scale: 1 }, mix = (a, b, angle) => along(a.map((x) => Math.cos(angle) * x), Math.sin(angle), b);
    const orient = (azimuth, elevation) => {
      const flat = mix(side, cross(up, side), azimuth), toward = mix(flat, up, elevation), right = cross(up, flat);
      Object.assign(view, { azimuth, elevation, rows: [right, cross(toward, right), toward] });
    };
    view.project = (place) => {
      const [x, y, z] = view.rows.map((row) => dot(row, along(place, -1, view.centre)));
      return [view.width / 2 + view.scale * x, view.height / 2 - view.scale * y, z];
    };
    // as large as the canvas allows
    const look = (azimuth, elevation) => {
      orient(azimuth, elevation);
      const all = [...surface.places, ...contacts.map(({ place, normal }) => along(place, ARROW, normal))], [wide, high] = [0, 1].map((k) =>
        all.map((place) => dot(view.rows[k], place)).reduce(([low, high], s) => [Math.min(low, s), Math.max(high, s)], [9, -9]));
      view.centre = along(view.rows[0].map((x) => (x * (wide[0] + wide[1])) / 2), (high[0] + high[1]) / 2, view.rows[1]);
      view.scale = Math.max(Math.min((0.88 * view.width) / (wide[1] - wide[0]), (view.height - 76) / (high[1] - high[0])), 10);
      draw();
    };
    // isometric, from where the contacts' normals point to
    const sum = contacts.reduce((sum, { normal }) => along(sum, 1, normal), [0, 0, 0]), quarter = Math.PI / 2;
    const start = (Math.floor(Math.atan2(dot(sum, cross(up, side)), dot(sum, side)) / quarter) + 0.5) * quarter, across = start + quarter / 2;

    let render = webgl(canvas, surface) ?? painter(canvas, surface), waiting = 0, playing = 0;
    const drawNow = () => {
      waiting = 0;
      if (!view.width) return;
      render(view);
      svg.innerHTML = contacts.map((contact) => contactDrawn(contact, view)).join("") + scaleDrawn(view, size, perMetre, unit);
    };
    const draw = () => { waiting ||= requestAnimationFrame(drawNow); };
    const turn = (dx, dy) => { orient(view.azimuth - dx, within(-quarter, view.elevation + dy, quarter)); draw(); };
    const move = (dx, dy) => { view.centre = along(along(view.centre, -dx / view.scale, view.rows[0]), dy / view.scale, view.rows[1]); draw(); };
    // what is at the place stays there
    const zoom = (factor, [x, y] = [view.width / 2, view.height / 2]) => {
      const scale = within(20, view.scale * factor, 40 * view.width), share = 1 - view.scale / scale;
      move(share * (view.width / 2 - x), share * (view.height / 2 - y));
      view.scale = scale;
    };
    const fingers = new Map(), spot = (event) => [event.offsetX, event.offsetY], on = (event, action) => canvas.addEventListener(event, action, { passive: false });
    on("webglcontextlost", (event) => event.preventDefault());
    on("webglcontextrestored", () => { render = webgl(canvas, surface); draw(); });
    on("pointerdown", (event) => {
      fingers.set(event.pointerId, spot(event));
      canvas.setPointerCapture(event.pointerId);
    });
    on("pointermove", (event) => {
      if (!fingers.has(event.pointerId)) return;
      const old = [...fingers.values()], [x, y] = fingers.get(event.pointerId), [dx, dy] = [event.offsetX - x, event.offsetY - y];
      const now = [...fingers.set(event.pointerId, spot(event)).values()], apart = ([a, b]) => Math.hypot(a[0] - b[0], a[1] - b[1]) || 1;
      if (old.length === 2) {
        move(dx / 2, dy / 2);
        zoom(apart(now) / apart(old), [0, 1].map((k) => (now[0][k] + now[1][k]) / 2));
      } else if (event.shiftKey) move(dx, dy);
      // a finger's way up or down scrolls the page until the view is tapped
      else turn(0.01 * dx, event.pointerType === "touch" && document.activeElement !== canvas ? 0 : 0.01 * dy);
    });
    on("lostpointercapture", (event) => fingers.delete(event.pointerId));
    on("click", () => canvas.focus({ preventScroll: true }));
    on("dblclick", () => acts.reset());
    on("wheel", (event) => {
      if (document.activeElement !== canvas) return;
      event.preventDefault();
      zoom(Math.exp(-0.0015 * event.deltaY), spot(event));
    });
    on("keydown", (event) => {
      const act = acts[{ "=": "+", "-": "−", 0: "reset" }[event.key] ?? event.key];
      if (!act || event.ctrlKey || event.metaKey || event.altKey) return;
      event.preventDefault();
      act();
    });

    // by words on buttons and by keys; where motion is not wanted a mode does not move but changes its sign
    const acts = {
      top: () => look(across, quarter), side: () => look(across, 0), bottom: () => look(across, -quarter), reset: () => look(start, ISOMETRIC),
      ArrowLeft: () => turn(-0.15, 0), ArrowRight: () => turn(0.15, 0), ArrowUp: () => turn(0, -0.15), ArrowDown: () => turn(0, 0.15),
      "+": () => zoom(1.25), "−": () => zoom(0.8), reverse: () => { view.bend = -view.bend; draw(); },
      stop: () => { cancelAnimationFrame(playing); play.textContent = matchMedia("(prefers-reduced-motion: reduce)").matches ? "reverse" : "animate"; },
      animate: () => {
        const began = performance.now(), step = (now) => {
          playing = requestAnimationFrame(step);
          view.bend = BEND * Math.cos((2 * Math.PI * (now - began)) / PERIOD);
          drawNow();
        };
        playing = requestAnimationFrame(step);
        play.textContent = "stop";
      },
    };
    figure.addEventListener("click", ({ target }) => target.type === "button" && acts[target.textContent]());
    const choose = () => {
      const field = fields[select.value], [heading, , marks] = bar.children;
      acts.stop();
      Object.assign(view, { field, bend: field?.shape ? BEND : 0, mesh: mesh.checked });
      [play.hidden, bar.hidden] = [!field?.shape, !field];
      if (field) {
        heading.textContent = field.name + (field.shape ? `: displacement over its largest, drawn as 5 % of the body's size` : field.unit && ` in ${field.unit}`);
        marks.innerHTML = [0, 0.25, 0.5, 0.75, 1].map((s) => `<span>${number(field.low + s * (field.high - field.low))}</span>`).join("");
      }
      draw();
    };
    figure.addEventListener("change", choose);
    choose();
    // a turned or zoomed view stays when its size changes
    new ResizeObserver(() => {
      const { clientWidth: width, clientHeight: height } = canvas, { width: old } = view, ratio = within(2, devicePixelRatio, 3);
      if (!width) return;
      Object.assign(view, { width, height, ratio, scale: (view.scale * width) / (old || 1) });
      Object.assign(canvas, { width: width * ratio, height: height * ratio });
      svg.setAttribute("viewBox", `0 0 ${width} ${height}`);
      if (!old) acts.reset();
      drawNow();
    }).observe(canvas);
  }
  document.querySelectorAll("figure.body-view").forEach(show);
})();
