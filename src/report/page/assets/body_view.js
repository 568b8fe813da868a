// A meshed body in 3D: every figure.body-view has its surface as JSON. WebGL draws it where there is some, else the painter's
// algorithm; arrows, labels and the scale are drawn over it, and the result is one 2D canvas, which prints as it is seen.
(() => {
  "use strict";
  const COLOURS = 64, CREASE = Math.cos((40 * Math.PI) / 180), BEND = 0.05, PERIOD = 2500;
  const decode = (text, Type) => new Type(Uint8Array.from(atob(text), (c) => c.charCodeAt(0)).buffer);
  const dot = (a, b) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
  const cross = (a, b) => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
  const along = (a, s, b) => [a[0] + s * b[0], a[1] + s * b[1], a[2] + s * b[2]];
  const within = (low, value, high) => Math.min(Math.max(value, low), high);
  const number = (value, digits = 3) => String(+value.toPrecision(digits)).replace("-", "−");
  const make = (tag, properties = {}, ...children) => {
    const element = Object.assign(document.createElement(tag), properties);
    element.append(...children);
    return element;
  };
  // cividis as in the other drawings: polynomials of d3-scale-chromatic
  const cividis = (t) => [
    [-4.54, -35.34, 2381.73, -6402.7, 7024.72, -2710.57],
    [32.49, 170.73, 52.82, -131.46, 176.58, -67.37],
    [81.24, 442.36, -2482.43, 6167.24, -6614.94, 2475.67],
  ].map((c) => within(0, Math.round(c.reduceRight((sum, each) => sum * t + each, 0)), 255));
  const MAP = Array.from({ length: COLOURS }, (_, k) => cividis(k / (COLOURS - 1)));

  // the surface in units of its largest extent, from the corner of its box
  function surfaceOf(data) {
    const points = Float32Array.from(decode(data.points, Uint16Array), (q) => q / 65535);
    const triangles = decode(data.triangles, Uint32Array), count = points.length / 3;
    const at = (k, of = points) => [of[3 * k], of[3 * k + 1], of[3 * k + 2]];
    const box = [0, 1, 2].map((axis) => {
      let most = 0;
      for (let k = axis; k < points.length; k += 3) most = Math.max(most, points[k]);
      return most;
    });
    const contacts = data.contacts.map(({ name, point, normal, radius }) => {
      const place = point.map((x, axis) => (x - data.low[axis]) / data.size);
      return { name, place, normal, radius: radius / data.size, metres: point };
    });
    // triangles around each node, one after the other from `start`
    const start = new Uint32Array(count + 1), around = new Uint32Array(triangles.length);
    for (const node of triangles) start[node + 1]++;
    for (let k = 0; k < count; k++) start[k + 1] += start[k];
    const next = start.slice();
    triangles.forEach((node, corner) => { around[next[node]++] = Math.floor(corner / 3); });
    return { data, points, triangles, count, at, box, contacts, start, around, edges: decode(data.edges, Uint32Array), fixed: decode(data.fixed, Uint8Array) };
  }

  // normals at the corners of all triangles: means of those around a node which do not differ by more than a crease
  function normalsAt({ triangles, at, start, around }, points) {
    const areas = new Float32Array(triangles.length), units = new Float32Array(triangles.length), normals = new Float32Array(3 * triangles.length);
    for (let t = 0; t < triangles.length; t += 3) {
      const [a, b, c] = [0, 1, 2].map((k) => at(triangles[t + k], points));
      const area = cross(along(b, -1, a), along(c, -1, a)), length = Math.hypot(...area) || 1;
      for (let k = 0; k < 3; k++) units[t + k] = (areas[t + k] = area[k]) / length;
    }
    for (let corner = 0; corner < triangles.length; corner++) {
      const own = at(Math.floor(corner / 3), units), node = triangles[corner];
      let sum = [0, 0, 0];
      for (let k = start[node]; k < start[node + 1]; k++) if (dot(own, at(around[k], units)) > CREASE) sum = along(sum, 1, at(around[k], areas));
      const length = Math.hypot(...sum) || 1;
      for (let k = 0; k < 3; k++) normals[3 * corner + k] = sum[k] / length;
    }
    return normals;
  }

  // edges of the elements; where four triangles are one face of an element, those within it are none
  function meshOf({ data, triangles, count }) {
    const inner = new Set(), lines = [];
    const sides = (t, visit) => [0, 1, 2].forEach((k) => visit(triangles[t + k], triangles[t + ((k + 1) % 3)]));
    const key = (a, b) => Math.min(a, b) * count + Math.max(a, b);
    if (data.split) for (let t = 9; t < triangles.length; t += 12) sides(t, (a, b) => inner.add(key(a, b)));
    for (let t = 0; t < triangles.length; t += 3) sides(t, (a, b) => { if (a < b && !inner.has(key(a, b))) lines.push(a, b); });
    return Uint32Array.from(lines);
  }

  function displaced({ points }, field, bend) {
    return field?.shape && bend ? points.map((x, k) => x + (bend * field.shape[k]) / 127) : points;
  }

  // the first triangle that a ray meets beyond `least`: how far, and the weights of its nodes
  function cast({ triangles, at }, from, direction, least) {
    let found = null;
    for (let t = 0; t < triangles.length; t += 3) {
      const a = at(triangles[t]), u = along(at(triangles[t + 1]), -1, a), v = along(at(triangles[t + 2]), -1, a);
      const p = cross(direction, v), volume = dot(u, p);
      if (Math.abs(volume) < 1e-14) continue;
      const s = along(from, -1, a), second = dot(s, p) / volume;
      if (second < 0 || second > 1) continue;
      const q = cross(s, u), third = dot(direction, q) / volume, far = dot(v, q) / volume;
      if (third < 0 || second + third > 1 || far < least || far >= (found?.far ?? Infinity)) continue;
      found = { far, t, weights: [1 - second - third, second, third] };
    }
    return found;
  }

  const VERTEX = `
    attribute vec3 place, normal, bent, shape; attribute float value, held;
    uniform mat3 axes; uniform vec3 centre; uniform vec2 zoom, shift; uniform float bend, turned;
    varying vec3 facing; varying float level, hatch;
    void main() {
      vec3 seen = axes * (place + bend * shape - centre);
      gl_Position = vec4(seen.xy * zoom + shift, -0.2 * seen.z, 1.0);
      facing = axes * mix(normal, bent, turned);
      level = value; hatch = held;
    }`;
  const FRAGMENT = `
    precision mediump float;
    varying vec3 facing; varying float level, hatch;
    uniform vec4 paint; uniform vec3 clamp_paint; uniform float lit, mapped, stripe; uniform sampler2D map;
    void main() {
      vec3 base = mapped > 0.5 ? texture2D(map, vec2(level, 0.5)).rgb : paint.rgb;
      if (hatch > 0.99) base = mix(base, clamp_paint, mod(gl_FragCoord.x + gl_FragCoord.y, stripe) < 0.36 * stripe ? 0.9 : 0.3 * (1.0 - mapped));
      float light = 0.5 + 0.5 * dot(normalize(facing), vec3(-0.36, 0.62, 0.7));
      gl_FragColor = lit > 0.5 ? vec4(base * (mapped > 0.5 ? 0.62 + 0.42 * light : 0.36 + 0.7 * light), 1.0) : vec4(paint.rgb * paint.a, paint.a);
    }`;

  // draws with WebGL into a canvas of its own; null where there is none
  function webgl(surface) {
    const canvas = make("canvas"), gl = canvas.getContext("webgl", { preserveDrawingBuffer: true });
    if (!gl) return null;
    const program = gl.createProgram();
    for (const [type, source] of [[gl.VERTEX_SHADER, VERTEX], [gl.FRAGMENT_SHADER, FRAGMENT]]) {
      const shader = gl.createShader(type);
      gl.shaderSource(shader, source);
      gl.compileShader(shader);
      gl.attachShader(program, shader);
    }
    gl.linkProgram(program);
    if (!gl.getProgramParameter(program, gl.LINK_STATUS)) return null;
    gl.useProgram(program);
    const uniform = (name) => gl.getUniformLocation(program, name);
    const [axes, centre, zoom, shift, bend, turned, paint, clamp, lit, mapped, stripe] =
      ["axes", "centre", "zoom", "shift", "bend", "turned", "paint", "clamp_paint", "lit", "mapped", "stripe"].map(uniform);
    gl.bindTexture(gl.TEXTURE_2D, gl.createTexture());
    gl.texImage2D(gl.TEXTURE_2D, 0, gl.RGBA, COLOURS, 1, 0, gl.RGBA, gl.UNSIGNED_BYTE, Uint8Array.from(MAP.flatMap((rgb) => [...rgb, 255])));
    for (const filter of [gl.TEXTURE_MIN_FILTER, gl.TEXTURE_MAG_FILTER]) gl.texParameteri(gl.TEXTURE_2D, filter, gl.NEAREST);
    for (const side of [gl.TEXTURE_WRAP_S, gl.TEXTURE_WRAP_T]) gl.texParameteri(gl.TEXTURE_2D, side, gl.CLAMP_TO_EDGE);
    gl.enable(gl.DEPTH_TEST);
    gl.depthFunc(gl.LEQUAL);
    gl.enable(gl.BLEND);
    gl.blendFunc(gl.ONE, gl.ONE_MINUS_SRC_ALPHA);
    gl.polygonOffset(1, 1);

    const upload = (values) => {
      const buffer = gl.createBuffer();
      gl.bindBuffer(gl.ARRAY_BUFFER, buffer);
      gl.bufferData(gl.ARRAY_BUFFER, values, gl.STATIC_DRAW);
      return buffer;
    };
    // of nodes, once for each corner or end of a line
    const spread = (nodes, values, width) => {
      const all = new values.constructor(width * nodes.length);
      nodes.forEach((node, corner) => { for (let k = 0; k < width; k++) all[width * corner + k] = values[width * node + k]; });
      return upload(all);
    };
    const attribute = (name, buffer, width, type) => {
      const place = gl.getAttribLocation(program, name);
      if (!buffer) return gl.disableVertexAttribArray(place);
      gl.bindBuffer(gl.ARRAY_BUFFER, buffer);
      gl.enableVertexAttribArray(place);
      gl.vertexAttribPointer(place, width, type, type !== gl.FLOAT, 0, 0);
    };
    const part = (nodes) => ({ nodes, place: spread(nodes, surface.points, 3), fields: new Map() });
    const faces = part(surface.triangles), edges = part(surface.edges);
    const normals = upload(normalsAt(surface, surface.points));
    // one triangle is fixed if all its nodes are, so no colour runs over an edge
    const held = upload(Uint8Array.from(surface.triangles, (_, k) => 255 * surface.triangles.subarray(k - (k % 3), k - (k % 3) + 3).every((node) => surface.fixed[node])));
    let mesh = null;
    const shown = ({ nodes, fields }, field) => {
      if (!field) return {};
      if (!fields.has(field)) {
        fields.set(field, {
          shape: field.shape && spread(nodes, field.shape, 3),
          value: nodes === surface.triangles && spread(nodes, field.values, 1),
          bent: nodes === surface.triangles && field.shape && upload(normalsAt(surface, displaced(surface, field, BEND))),
        });
      }
      return fields.get(field);
    };
    const use = (what, field, asFaces) => {
      const { shape, value, bent } = shown(what, field);
      attribute("place", what.place, 3, gl.FLOAT);
      attribute("shape", shape, 3, gl.BYTE);
      attribute("normal", asFaces && normals, 3, gl.FLOAT);
      attribute("bent", asFaces && (bent || normals), 3, gl.FLOAT);
      attribute("value", asFaces && value, 1, gl.UNSIGNED_BYTE);
      attribute("held", asFaces && held, 1, gl.UNSIGNED_BYTE);
    };
    return (context, view) => {
      const { width, height, ratio, colours, field } = view;
      if (gl.isContextLost()) return false;
      if (canvas.width !== width * ratio || canvas.height !== height * ratio) Object.assign(canvas, { width: width * ratio, height: height * ratio });
      gl.viewport(0, 0, canvas.width, canvas.height);
      gl.clear(gl.COLOR_BUFFER_BIT | gl.DEPTH_BUFFER_BIT);
      const rows = view.axes();
      gl.uniformMatrix3fv(axes, false, [0, 1, 2].flatMap((k) => rows.map((row) => row[k])));
      gl.uniform3fv(centre, view.centre);
      gl.uniform2f(zoom, (2 * view.scale) / width, (2 * view.scale) / height);
      gl.uniform3fv(clamp, colours.fixed.map((c) => c / 255));
      gl.uniform1f(stripe, 9 * ratio);
      const draw = (what, mode, rgb, alpha, bent, nudges = [[0, 0]]) => {
        use(what, field, mode === gl.TRIANGLES);
        gl.uniform4fv(paint, [...rgb.map((c) => c / 255), alpha]);
        gl.uniform1f(lit, Number(mode === gl.TRIANGLES));
        gl.uniform1f(bend, bent);
        gl.uniform1f(turned, bent / BEND);
        for (const [x, y] of nudges) {
          gl.uniform2f(shift, (x * 2) / canvas.width, (y * 2) / canvas.height);
          gl.drawArrays(mode, 0, what.nodes.length);
        }
      };
      gl.uniform1f(mapped, Number(!!field));
      gl.enable(gl.POLYGON_OFFSET_FILL);
      draw(faces, gl.TRIANGLES, colours.body, 1, view.bend);
      gl.disable(gl.POLYGON_OFFSET_FILL);
      if (view.mesh) draw((mesh ??= part(view.mesh)), gl.LINES, colours.line, 0.5, view.bend);
      if (view.bend) draw(edges, gl.LINES, colours.line, 0.35, 0);
      // lines are one pixel wide: wider ones by drawing them moved
      const half = ratio / 4;
      draw(edges, gl.LINES, colours.line, 1, view.bend, [[-half, 0], [half, 0], [0, -half], [0, half]]);
      context.drawImage(canvas, 0, 0, width, height);
      return true;
    };
  }

  // the same on a 2D canvas: triangles and lines that face the viewer, from the farthest
  const painter = (surface) => (context, view) => {
    const { colours, field } = view, { triangles, edges, fixed } = surface;
    const points = displaced(surface, field, view.bend), depth = new Float32Array(surface.count), seen = [];
    const normal = (t) => cross(along(seen[triangles[t + 1]], -1, seen[triangles[t]]), along(seen[triangles[t + 2]], -1, seen[triangles[t]]));
    for (let k = 0; k < surface.count; k++) {
      const [x, y, z] = view.project(surface.at(k, points));
      seen.push([x, -y, (depth[k] = z * view.scale)]);
    }
    const items = [], front = new Uint8Array(surface.count);
    for (let t = 0; t < triangles.length; t += 3) {
      const facing = normal(t);
      if (facing[2] <= 0) continue;
      const nodes = triangles.subarray(t, t + 3), light = 0.5 + (0.5 * dot(facing, [-0.36, 0.62, 0.7])) / Math.hypot(...facing);
      for (const node of nodes) front[node] = 1;
      let rgb = field ? MAP[Math.min(Math.floor(((field.values[nodes[0]] + field.values[nodes[1]] + field.values[nodes[2]]) / 765) * COLOURS), COLOURS - 1)] : colours.body;
      if (nodes.every((node) => fixed[node])) rgb = rgb.map((c, k) => 0.45 * c + 0.55 * colours.fixed[k]);
      const strength = field ? 0.62 + 0.42 * light : 0.36 + 0.7 * light;
      items.push({ nodes, far: (depth[nodes[0]] + depth[nodes[1]] + depth[nodes[2]]) / 3, colour: `rgb(${rgb.map((c) => Math.round(c * strength))})` });
    }
    const lines = (list, width, alpha) => {
      for (let k = 0; k < list.length; k += 2) {
        const nodes = list.subarray(k, k + 2);
        if (front[nodes[0]] && front[nodes[1]]) items.push({ nodes, far: Math.max(depth[nodes[0]], depth[nodes[1]]) + 0.02 * view.scale, width, colour: `rgba(${colours.line},${alpha})` });
      }
    };
    if (view.mesh) lines(view.mesh, 0.5, 0.5);
    lines(edges, 1.2, 1);
    items.sort((a, b) => a.far - b.far);
    context.lineJoin = "round";
    for (const { nodes, colour, width } of items) {
      context.beginPath();
      for (const node of nodes) context.lineTo(seen[node][0], -seen[node][1]);
      context.strokeStyle = context.fillStyle = colour;
      context.lineWidth = width ?? 0.7;
      if (!width) {
        context.closePath();
        context.fill();
      }
      context.stroke();
    }
    return true;
  };

  // contacts, axes and the scale, over the body; `under` is drawn before it, so that it hides what is behind
  function annotate(context, view, surface, under) {
    const { colours, width, height } = view, ink = `rgb(${colours.ink})`, mark = `rgb(${colours.contact})`;
    const line = (points, dash = []) => {
      context.setLineDash(dash);
      context.beginPath();
      for (const [x, y] of points) context.lineTo(x, y);
      context.stroke();
      context.setLineDash([]);
    };
    const text = (words, [x, y], colour = ink) => {
      context.lineWidth = 4;
      context.strokeStyle = `rgb(${colours.ground})`;
      context.strokeText(words, x, y);
      context.fillStyle = colour;
      context.fillText(words, x, y);
    };
    const head = ([x, y], [dx, dy], size) => {
      context.beginPath();
      context.moveTo(x, y);
      for (const side of [-1, 1]) context.lineTo(x - size * dx - side * 0.4 * size * dy, y - size * dy + side * 0.4 * size * dx);
      context.fill();
    };
    context.font = "600 13px system-ui, sans-serif";
    context.textBaseline = "middle";
    context.lineJoin = "round";
    for (const { name, place, normal, radius, hidden } of surface.contacts) {
      if (under && !hidden) continue;
      context.globalAlpha = hidden && !under ? 0.4 : 1;
      context.strokeStyle = context.fillStyle = mark;
      const tip = view.project(place), tail = view.project(along(place, view.arrow, normal));
      const long = Math.hypot(tail[0] - tip[0], tail[1] - tip[1]) || 1;
      const inward = [(tip[0] - tail[0]) / long, (tip[1] - tail[1]) / long];
      if (radius <= 0.6) {
        const [x, y] = view.project(along(place, radius, normal));
        context.lineWidth = 1;
        context.setLineDash([3, 4]);
        context.beginPath();
        context.arc(x, y, radius * view.scale, 0, 2 * Math.PI);
        context.stroke();
      }
      context.lineWidth = 2.4;
      if (long > 14) {
        line([tail, [tip[0] - 8 * inward[0], tip[1] - 8 * inward[1]]], hidden && !under ? [3, 3] : []);
        head(tip, inward, 11);
      }
      context.beginPath();
      context.arc(tip[0], tip[1], 3.4, 0, 2 * Math.PI);
      context.fill();
      const beyond = long > 14 ? [tail[0] - 11 * inward[0], tail[1] - 11 * inward[1]] : [tip[0], tip[1] - 14];
      context.textAlign = inward[0] > 0.5 && long > 14 ? "right" : inward[0] < -0.5 && long > 14 ? "left" : "center";
      context.globalAlpha = 1;
      const half = context.measureText(name).width / 2 + 4;
      if (!under) text(name, [within(half, beyond[0], width - half), within(10, beyond[1], height - 10)], mark);
    }
    context.globalAlpha = 1;
    if (under) return;
    // the axes of the file
    context.font = "13px system-ui, sans-serif";
    context.textAlign = "center";
    const [right, up] = view.axes(), corner = [34, height - 34];
    ["x", "y", "z"].forEach((name, k) => {
      const end = (s) => [corner[0] + s * right[k], corner[1] - s * up[k]];
      context.strokeStyle = `rgb(${colours.soft})`;
      context.lineWidth = 1.4;
      line([corner, end(18)]);
      text(name, end(26), `rgb(${colours.soft})`);
    });
    // a round length, at most a quarter of the width
    const most = (0.25 * width * surface.data.size) / view.scale, decade = 10 ** Math.floor(Math.log10(most));
    const metres = decade * [5, 2, 1].find((step) => step * decade <= most);
    const bar = (metres / surface.data.size) * view.scale, y = height - 14, x = width - 14;
    context.strokeStyle = ink;
    context.lineWidth = 1.6;
    line([[x - bar, y - 5], [x - bar, y], [x, y], [x, y - 5]]);
    text(lengthIn(metres), [x - bar / 2, y - 14]);
  }
  const lengthIn = (metres) => (metres >= 0.999e-3 ? `${number(metres * 1e3, 4)} mm` : `${number(metres * 1e6, 4)} µm`);
  const listed = (metres) => {
    const small = Math.max(...metres.map(Math.abs)) < 1e-3;
    return `${metres.map((x) => number(x * (small ? 1e6 : 1e3), 4)).join(small ? " × " : " × ")} ${small ? "µm" : "mm"}`;
  };

  function show(figure) {
    const data = JSON.parse(figure.querySelector("script").textContent);
    const surface = surfaceOf(data), { contacts, box } = surface;
    const fields = data.fields.map((field) => ({ ...field, values: decode(field.values, Uint8Array), shape: field.shape && decode(field.shape, Int8Array) }));
    const canvas = make("canvas", { tabIndex: 0 }), context = canvas.getContext("2d");
    const render = webgl(surface) ?? painter(surface);

    // the axis of the body that is nearest to the outer contact's normal is up, z in doubt
    const outward = contacts[0]?.normal ?? [0, 0, 1];
    const axis = [2, 0, 1].reduce((best, k) => (Math.abs(outward[k]) > Math.abs(outward[best]) + 1e-3 ? k : best));
    const unit = (k, sign = 1) => [0, 1, 2].map((other) => (other === k ? sign : 0));
    const up = unit(axis, Math.sign(outward[axis]) || 1), side = unit((axis + 1) % 3), other = cross(up, side);
    const view = {
      azimuth: 0, elevation: 0, scale: 1, centre: [0, 0, 0], width: 0, height: 0, ratio: 1, bend: 0, field: null, mesh: null, arrow: 0.2,
      axes() {
        const { azimuth: a, elevation: e } = this;
        const flat = along(side.map((x) => x * Math.cos(a)), Math.sin(a), other), right = along(side.map((x) => -x * Math.sin(a)), Math.cos(a), other);
        const toward = along(flat.map((x) => x * Math.cos(e)), Math.sin(e), up);
        return [right, cross(toward, right), toward];
      },
      project(place) {
        const [right, above, toward] = this.axes(), from = along(place, -1, this.centre);
        return [this.width / 2 + this.scale * dot(right, from), this.height / 2 - this.scale * dot(above, from), dot(toward, from)];
      },
    };
    const see = () => {
      const toward = view.axes()[2];
      for (const contact of contacts) contact.hidden = cast(surface, along(contact.place, 2e-3, contact.normal), toward, 2e-3) != null;
    };
    // body and arrows as large as the canvas allows
    const fit = () => {
      const [right, above] = view.axes(), ends = contacts.map(({ place, normal }) => along(place, view.arrow, normal));
      const span = [right, above].map((direction) => {
        let [low, high] = [Infinity, -Infinity];
        const widen = (place) => { const s = dot(direction, place); low = Math.min(low, s); high = Math.max(high, s); };
        for (let k = 0; k < surface.count; k++) widen(surface.at(k));
        ends.forEach(widen);
        return [low, high];
      });
      view.centre = along(right.map((x) => (x * (span[0][0] + span[0][1])) / 2), (span[1][0] + span[1][1]) / 2, above);
      view.scale = Math.max(Math.min((0.88 * view.width) / (span[0][1] - span[0][0]), (view.height - 76) / (span[1][1] - span[1][0])), 10);
    };
    const look = (azimuth, elevation) => {
      Object.assign(view, { azimuth, elevation });
      fit();
      draw();
    };
    // isometric, from where most contacts are seen
    const ISOMETRIC = Math.asin(Math.sqrt(1 / 3));
    const start = [-1, 1, 3, 5].map((k) => (k * Math.PI) / 4).reduce((best, azimuth) => {
      Object.assign(view, { azimuth, elevation: ISOMETRIC });
      see();
      const seen = contacts.filter(({ hidden }) => !hidden).length + contacts.reduce((sum, { normal }) => sum + 0.1 * dot(normal, view.axes()[2]), 0);
      return seen > (best?.seen ?? -Infinity) + 1e-6 ? { azimuth, seen } : best;
    }, null).azimuth;
    const reset = () => look(start, ISOMETRIC);

    let paper = false, waiting = 0;
    const rgb = (name) => {
      context.fillStyle = getComputedStyle(figure).getPropertyValue(`--${name}`).trim();
      return [1, 3, 5].map((k) => parseInt(context.fillStyle.slice(k, k + 2), 16));
    };
    const drawNow = () => {
      if (!view.width) return;
      view.colours = { body: rgb("view-body"), fixed: rgb("view-fixed"), contact: rgb("view-contact"), line: rgb("view-line"), ink: rgb("fg"), soft: rgb("soft"), ground: rgb("card") };
      see();
      context.setTransform(view.ratio, 0, 0, view.ratio, 0, 0);
      context.clearRect(0, 0, view.width, view.height);
      annotate(context, view, surface, true);
      render(context, view);
      annotate(context, view, surface, false);
    };
    const draw = () => { waiting ||= requestAnimationFrame(() => { waiting = 0; drawNow(); }); };

    const turn = (dx, dy) => {
      view.azimuth -= dx;
      view.elevation = within(-Math.PI / 2, view.elevation + dy, Math.PI / 2);
      draw();
    };
    const move = (dx, dy) => {
      const [right, above] = view.axes();
      view.centre = along(along(view.centre, -dx / view.scale, right), dy / view.scale, above);
      draw();
    };
    // what is under the place stays there
    const zoom = (factor, [x, y] = [view.width / 2, view.height / 2]) => {
      const scale = within(20, view.scale * factor, 40 * Math.max(view.width, view.height)), grown = scale / view.scale;
      move((1 - 1 / grown) * (view.width / 2 - x), (1 - 1 / grown) * (view.height / 2 - y));
      view.scale = scale;
    };

    // mouse and touch
    const fingers = new Map();
    let entered = false;
    const place = (event) => [event.offsetX, event.offsetY];
    canvas.addEventListener("pointerdown", (event) => {
      fingers.set(event.pointerId, place(event));
      canvas.setPointerCapture(event.pointerId);
      entered = true;
    });
    canvas.addEventListener("pointermove", (event) => {
      if (!fingers.has(event.pointerId)) return read(place(event));
      const before = [...fingers.values()], old = fingers.get(event.pointerId);
      fingers.set(event.pointerId, place(event));
      const [dx, dy] = [event.offsetX - old[0], event.offsetY - old[1]];
      if (before.length === 1) {
        // a finger's way up and down scrolls the page until the view is tapped
        const scrolls = event.pointerType === "touch" && document.activeElement !== canvas;
        event.shiftKey || event.buttons & 6 ? move(dx, dy) : turn(0.01 * dx, scrolls ? 0 : 0.01 * dy);
      } else if (before.length === 2) {
        const after = [...fingers.values()], apart = ([a, b]) => Math.hypot(a[0] - b[0], a[1] - b[1]) || 1;
        move(dx / 2, dy / 2);
        zoom(apart(after) / apart(before), [0, 1].map((k) => (after[0][k] + after[1][k]) / 2));
      }
    });
    for (const end of ["pointerup", "pointercancel"]) canvas.addEventListener(end, (event) => fingers.delete(event.pointerId));
    canvas.addEventListener("click", (event) => { canvas.focus({ preventScroll: true }); read(place(event)); });
    canvas.addEventListener("contextmenu", (event) => event.preventDefault());
    canvas.addEventListener("dblclick", reset);
    canvas.addEventListener("pointerleave", () => { entered = false; value.textContent = ""; });
    canvas.addEventListener("wheel", (event) => {
      if (!entered) return;
      event.preventDefault();
      zoom(Math.exp(-0.0015 * event.deltaY * (event.deltaMode ? 20 : 1)), place(event));
    }, { passive: false });
    canvas.addEventListener("keydown", (event) => {
      const [x, y] = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, -1], ArrowDown: [0, 1] }[event.key] ?? [0, 0];
      if (event.ctrlKey || event.metaKey || event.altKey) return;
      if (x || y) event.shiftKey ? move(24 * x, 24 * y) : turn(0.15 * x, 0.15 * y);
      else if ("+=".includes(event.key)) zoom(1.25);
      else if ("-_".includes(event.key)) zoom(0.8);
      else if (event.key === "0" || event.key === "Home") reset();
      else return;
      event.preventDefault();
    });

    // place and value under the pointer; of a deformed body the place would be wrong
    const value = make("output", { className: "body-view-value" });
    const read = ([x, y]) => {
      const [right, above, toward] = view.axes();
      const plane = along(along(view.centre, (x - view.width / 2) / view.scale, right), (view.height / 2 - y) / view.scale, above);
      const found = view.bend ? null : cast(surface, along(plane, 9, toward), toward.map((c) => -c), 0);
      if (!found) return (value.textContent = "");
      const mean = (of) => found.weights.reduce((sum, weight, k) => sum + weight * of(surface.triangles[found.t + k]), 0);
      const metres = [0, 1, 2].map((k) => data.low[k] + data.size * mean((node) => surface.points[3 * node + k]));
      const { field } = view, at = `(${metres.map((m) => number(Math.round(m / (1e-4 * data.size)) * 0.1 * data.size, 4)).join(", ")}) mm`;
      value.textContent = field ? `${number(field.low + (mean((node) => field.values[node]) / 255) * (field.high - field.low), 2)} ${field.unit} at ${at}` : at;
    };

    // what is shown, and from where
    const calm = matchMedia("(prefers-reduced-motion: reduce)").matches;
    const button = (name, action, properties = {}) => {
      const element = make("button", { type: "button", textContent: name, ...properties });
      element.addEventListener("click", action);
      return element;
    };
    const select = make("select", {}, new Option("geometry", -1), ...fields.map(({ name }, k) => new Option(name, k)));
    const scale = make("div", { className: "body-view-scale", hidden: true });
    let playing = 0;
    const stop = () => {
      cancelAnimationFrame(playing);
      playing = 0;
      play.textContent = calm ? "reverse" : "animate";
    };
    // the deformation is still at its largest until the animation is asked for; without motion it changes its sign
    const play = button("", () => {
      if (calm) view.bend = -view.bend;
      else if (playing) stop();
      else {
        const began = performance.now();
        const step = (now) => {
          view.bend = BEND * Math.cos((2 * Math.PI * (now - began)) / PERIOD);
          drawNow();
          playing = requestAnimationFrame(step);
        };
        playing = requestAnimationFrame(step);
        play.textContent = "stop";
      }
      draw();
    }, { hidden: true });
    const choose = () => {
      const field = fields[select.value] ?? null;
      stop();
      Object.assign(view, { field, bend: field?.shape ? BEND : 0 });
      play.hidden = !field?.shape;
      scale.hidden = !field;
      value.textContent = "";
      if (field) {
        const marks = [0, 0.25, 0.5, 0.75, 1].map((s) => make("span", { textContent: number(field.low + s * (field.high - field.low)) }));
        const what = field.shape ? `${field.name}: displacement over its largest, drawn as ${100 * BEND} % of the body's size` : `${field.name}${field.unit ? ` in ${field.unit}` : ""}`;
        scale.replaceChildren(make("div", { textContent: what }), make("div", { className: "body-view-bar" }), make("div", { className: "body-view-marks" }, ...marks));
        scale.children[1].style.background = `linear-gradient(to right,${MAP.map((c) => `rgb(${c})`)})`;
      }
      draw();
    };
    select.addEventListener("change", choose);
    const mesh = make("input", { type: "checkbox" });
    let lines = null;
    mesh.addEventListener("change", () => { view.mesh = mesh.checked ? (lines ??= meshOf(surface)) : null; draw(); });
    const steep = Math.PI / 2;
    const from = (name, title, azimuth, elevation) => button(name, () => look(azimuth, elevation), { title });
    const controls = make("div", { className: "body-view-controls" },
      make("label", {}, "Show ", select), play, make("label", {}, mesh, " mesh"),
      make("span", { className: "body-view-buttons" },
        from("top", "See the body from above", start, steep), from("side", "See the body from the side", Math.round((start / steep)) * steep, 0), from("bottom", "See the body from below", start, -steep),
        button("+", () => zoom(1.25), { title: "Enlarge", ariaLabel: "zoom in" }), button("−", () => zoom(0.8), { title: "Reduce", ariaLabel: "zoom out" }),
        button("reset", reset, { title: "First view" })));
    controls.setAttribute("role", "group");
    controls.setAttribute("aria-label", "What is shown of the body, and from where");

    const isFixed = surface.fixed.some((each) => each), size = listed(box.map((x) => x * data.size));
    const key = (className, words) => make("li", {}, make("span", { className: `body-view-key ${className}` }), words);
    const legend = make("ul", { className: "body-view-legend" },
      ...(isFixed ? [key("fixed", "fixed")] : [make("li", { textContent: "nothing is fixed" })]),
      ...(contacts.length ? [key("contact", "contact point and force on the body")] : []),
      ...(contacts.some(({ radius }) => radius <= 0.6) ? [key("tip", "sphere of the tip radius")] : []),
      make("li", { textContent: `${size} (x, y, z)` }));
    const hint = make("p", { className: "body-view-hint" },
      make("span", { className: "with-mouse", textContent: "Drag or arrow keys turn the body. + and − zoom, the wheel too after a click. Shift moves, a double click resets." }),
      make("span", { className: "with-fingers", textContent: "One finger turns the body: sideways at once, all ways after a tap. Two fingers zoom, a double tap resets." }));
    canvas.setAttribute("role", "img");
    canvas.setAttribute("aria-label", [`The body in 3D, ${size} along x, y and z.`,
      ...contacts.map(({ name, metres }) => `The ${name} contact is at ${listed(metres).replace(/ × /g, ", ")}.`),
      isFixed ? "Its fixed faces are hatched." : "Nothing is fixed.", "Arrow keys turn it, plus and minus zoom, 0 resets."].join(" "));
    const parts = make("div", { className: "body-view-parts" }, controls, make("div", { className: "body-view-frame" }, canvas, value), scale, legend, hint);
    figure.prepend(parts);
    figure.classList.add("drawn-in-3d");

    // the size is the frame's; a view that is turned or zoomed stays
    const resize = () => {
      const { clientWidth: width, clientHeight: height } = canvas;
      if (!width || (width === view.width && height === view.height)) return;
      const first = !view.width, grown = width / view.width;
      const ratio = Math.min(Math.max(devicePixelRatio, 2), 3);
      Object.assign(view, { width, height, ratio, scale: first ? 1 : view.scale * grown });
      Object.assign(canvas, { width: width * ratio, height: height * ratio });
      if (first) {
        Object.assign(view, { azimuth: start, elevation: ISOMETRIC });
        fit();
      }
      drawNow();
    };
    new ResizeObserver(resize).observe(canvas);
    matchMedia("(prefers-color-scheme: dark)").addEventListener("change", draw);
    // paper is light, whatever the screen is
    for (const [name, on] of [["beforeprint", true], ["afterprint", false]]) {
      addEventListener(name, () => {
        figure.classList.toggle("on-paper", (paper = on));
        drawNow();
      });
    }
    choose();
    resize();
  }
  document.querySelectorAll("figure.body-view").forEach(show);
})();
