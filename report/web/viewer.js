"use strict";
// A problem in 3D: its solids, the robot by the geometry that was checked at start and goal, and its paths side by side, played or scrubbed.
// Poses are computed beforehand (report/view_data.h); the view interpolates between neighbouring frames alone.
// `previous`: a viewer whose place this one takes, seen from the same point.
function makeViewer(container, data, previous = null) {
  const seenFrom = previous && previous.seenFrom();
  if (previous) previous.dispose();
  const element = (tag, attributes, ...children) => {
    const made = document.createElement(tag);
    for (const [name, value] of Object.entries(attributes)) made.setAttribute(name, value);
    made.append(...children);
    return made;
  };
  const colour = name => new THREE.Color(theme.property(name));
  const series = place => new THREE.Color(theme.property("--series").split(",")[place].trim());

  // ---- Bodies -----------------------------------------------------------------------------------
  // Numbers of so many bytes each, from base64 (report/shape_json.h).
  function numbers(text, numBytes) {
    const bytes = atob(text);
    const made = new (numBytes === 2 ? Uint16Array : Uint32Array)(bytes.length / numBytes);
    for (let i = 0; i < bytes.length; ++i) made[Math.floor(i / numBytes)] |= bytes.charCodeAt(i) << (8 * (i % numBytes));
    return made;
  }

  function meshGeometry({low, size, vertices, triangles}) {
    const steps = numbers(vertices, 2);
    const made = new THREE.BufferGeometry();
    made.setAttribute("position", new THREE.BufferAttribute(Float32Array.from(steps, (step, i) => low[i % 3] + size[i % 3] * step / 65535), 3));
    made.setIndex(new THREE.BufferAttribute(numbers(triangles, steps.length / 3 > 65536 ? 4 : 2), 1));
    const flat = made.toNonIndexed();
    flat.computeVertexNormals();
    return flat;
  }

  const madeOfMeshes = new Map();  // by id: a robot's are in every copy of it
  function geometry(shape) {
    switch (shape.type) {
      case "box": return new THREE.BoxBufferGeometry(...shape.size);
      case "sphere": return new THREE.SphereBufferGeometry(shape.radius, 24, 16);
      // Those of three.js stand along y, ours along z.
      case "cylinder": return new THREE.CylinderBufferGeometry(shape.radius, shape.radius, shape.length, 32).rotateX(Math.PI / 2);
      case "cone": return new THREE.ConeBufferGeometry(shape.radius, shape.length, 32).rotateX(Math.PI / 2);
      case "half-space": return new THREE.BoxBufferGeometry(4, 4, 0.01).translate(0, 0, -0.005);
      case "mesh":
        if (!madeOfMeshes.has(shape.mesh)) madeOfMeshes.set(shape.mesh, meshGeometry(data.meshes[shape.mesh]));
        return madeOfMeshes.get(shape.mesh);
    }
    return null;
  }

  // Found once for a mesh, too, wherever it stands.
  const outline = body => body.userData.outline || (body.userData.outline = new THREE.EdgesGeometry(body, 30));

  function solid(shape, material) {
    if (shape.type !== "capsule") return new THREE.Mesh(geometry(shape), material);
    const group = new THREE.Group();
    group.add(new THREE.Mesh(geometry({...shape, type: "cylinder"}), material));
    for (const side of [-1, 1]) {
      const cap = new THREE.Mesh(geometry({type: "sphere", radius: shape.radius}), material);
      cap.position.z = side * shape.length / 2;
      group.add(cap);
    }
    return group;
  }

  function place(object, pose, offset = 0) {
    object.position.set(pose[offset], pose[offset + 1], pose[offset + 2]);
    object.quaternion.set(pose[offset + 3], pose[offset + 4], pose[offset + 5], pose[offset + 6]);
  }

  const moving = data.links.filter(link => link.moves);
  // The robot with what is attached to it; `poses`: those of the links that move, null: at the start.
  function robot(material, poses, movingAlone) {
    const group = new THREE.Group();
    const parts = [];
    for (const link of movingAlone ? moving : data.links) {
      const part = new THREE.Group();
      place(part, link.pose);
      for (const [x, y, z, radius] of link.spheres) {
        const sphere = new THREE.Mesh(new THREE.SphereBufferGeometry(radius, 20, 14), material);
        sphere.position.set(x, y, z);
        part.add(sphere);
      }
      for (const one of [...link.shapes, ...data.solids.filter(one => one.link === link.name)]) {
        const body = solid(one.shape, material);
        place(body, one.pose);
        part.add(body);
      }
      group.add(part);
      if (link.moves) parts.push(part);
    }
    const set = list => parts.forEach((part, i) => place(part, list, 7 * i));
    if (poses) set(poses);
    return {group, parts, set};
  }

  // Between two frames: positions on the line, orientations on the great circle.
  const before = new THREE.Object3D(), after = new THREE.Object3D();
  function pose(one, motion, time) {
    const at = time * (motion.frames.length - 1);
    const frame = Math.min(Math.floor(at), motion.frames.length - 1);
    const next = Math.min(frame + 1, motion.frames.length - 1);
    one.parts.forEach((part, i) => {
      place(before, motion.frames[frame], 7 * i);
      place(after, motion.frames[next], 7 * i);
      part.position.lerpVectors(before.position, after.position, at - frame);
      THREE.Quaternion.slerp(before.quaternion, after.quaternion, part.quaternion, at - frame);
    });
  }

  // ---- Scenes: one a path, or one alone -----------------------------------------------------------
  const material = (shade, opacity = 1) => new THREE.MeshLambertMaterial({
    color: shade, transparent: opacity < 1, opacity, depthWrite: opacity === 1,
    polygonOffset: opacity < 1, polygonOffsetFactor: 1, polygonOffsetUnits: 1,  // behind a body at the same place
  });
  function makeScene(motion) {
    const scene = new THREE.Scene();
    scene.background = colour("--panel");
    scene.add(new THREE.HemisphereLight(0xffffff, 0x999999, 1));
    const sun = new THREE.DirectionalLight(0xffffff, 0.5);
    sun.position.set(2, -3, 5);
    scene.add(sun);
    const wood = material(colour("--muted"), 0.22);
    const objects = new THREE.Group();
    scene.add(objects);
    for (const one of data.solids.filter(one => !one.link)) {
      const body = solid(one.shape, wood);
      place(body, one.pose);
      objects.add(body);
      if (one.shape.type === "box" || one.shape.type === "mesh") {
        const edges = new THREE.LineSegments(outline(geometry(one.shape)),
                                             new THREE.LineBasicMaterial({color: colour("--text"), transparent: true, opacity: 0.6}));
        place(edges, one.pose);
        scene.add(edges);
      }
    }
    const start = robot(material(series(2), 0.3), null, true), goal = {group: new THREE.Group()};
    for (const poses of data.goals) goal.group.add(robot(material(series(1), 0.3), poses, true).group);
    scene.add(start.group, goal.group);
    const body = robot(material(series(0)), null, false);
    scene.add(body.group);
    let hit = null;
    if (motion) {
      for (const tip of motion.tips) {
        const trail = new THREE.BufferGeometry();
        trail.setAttribute("position", new THREE.Float32BufferAttribute(tip.flat(), 3));
        scene.add(new THREE.Line(trail, new THREE.LineBasicMaterial({color: colour("--accent")})));
      }
      if (motion.collision !== undefined) {
        hit = robot(material(colour("--failure"), 0.55), motion.frames[motion.collision], true);
        scene.add(hit.group);
      }
    }
    return {scene, motion, objects, start, goal, body, hit};
  }
  let scenes = [];
  let bounds = null;  // a sphere about all of the first

  // ---- Picture ----------------------------------------------------------------------------------
  const HOW_TO_MOVE = "Drag or arrow keys turn, wheel or + and - come nearer and go away, right button or shift and arrow keys move.";
  const canvas = element("canvas", {tabindex: "0", "aria-label": "3D view. " + HOW_TO_MOVE});
  const renderer = new THREE.WebGLRenderer({canvas, antialias: true, preserveDrawingBuffer: true});
  renderer.setPixelRatio(devicePixelRatio);
  const camera = new THREE.PerspectiveCamera(40, 1, 0.05, 50);
  camera.up.set(0, 0, 1);
  const controls = new THREE.OrbitControls(camera, canvas);
  controls.enableKeys = false;

  let fitted = 1;  // the share of the width that a picture lacks to be as wide as high: from so much further away it is seen
  function look(direction) {
    const box = new THREE.Box3().setFromObject(scenes[0].body.group).union(new THREE.Box3().setFromObject(scenes[0].goal.group));
    if (box.isEmpty()) box.setFromObject(scenes[0].scene);  // of a robot that cannot be shown
    for (const motion of data.motions) for (const point of motion.tips.flat()) box.expandByPoint(new THREE.Vector3(...point));
    // What is near comes into view with it, but floors and walls do not shrink it.
    const sizeOf = one => one.getSize(new THREE.Vector3()).length();
    const size = sizeOf(box), near = box.clone().expandByScalar(size / 4);
    for (const object of scenes[0].objects.children) {
      const part = new THREE.Box3().setFromObject(object);
      if (sizeOf(part) < 2 * size && part.intersectsBox(near)) box.union(part.intersect(near));
    }
    const centre = box.getCenter(new THREE.Vector3());
    const distance = 1.6 * (sizeOf(box) || 1) / fitted;
    controls.target.copy(centre);
    camera.position.copy(centre).addScaledVector(new THREE.Vector3(...direction).normalize(), distance);
    controls.update();
  }

  const NARROW = 600;  // px, below which paths stand one above the other
  function draw() {
    if (canvas.clientWidth === 0) return;
    const stacked = container.classList.toggle("stacked", scenes.length > 1 && canvas.clientWidth < NARROW);
    const width = canvas.clientWidth / (stacked ? 1 : scenes.length), height = canvas.clientHeight / (stacked ? scenes.length : 1);
    renderer.setSize(canvas.clientWidth, canvas.clientHeight, false);
    camera.aspect = width / height;
    const fit = Math.min(1, camera.aspect);
    approach(fitted / fit);
    fitted = fit;
    camera.far = Math.max(50, camera.position.distanceTo(bounds.center) + 2 * bounds.radius);
    camera.near = camera.far / 1000;
    camera.updateProjectionMatrix();
    renderer.setScissorTest(false);
    renderer.setClearColor(colour("--line"));
    renderer.clear();
    renderer.setScissorTest(true);
    scenes.forEach((one, i) => {
      const [left, bottom] = stacked ? [0, canvas.clientHeight - (i + 1) * height] : [i * width, 0];
      renderer.setViewport(left, bottom, width, height);
      renderer.setScissor(left + 1, bottom + 1, width - 2, height - 2);  // in a frame
      renderer.render(one.scene, camera);
    });
  }

  // ---- Controls ---------------------------------------------------------------------------------
  const slider = element("input", {type: "range", min: "0", max: "1000", value: "0", "aria-label": "Place on the path"});
  const play = element("button", {type: "button"}, "Play");
  let time = 0, started = null;
  function moveTo(fraction) {
    time = Math.min(Math.max(fraction, 0), 1);
    slider.value = String(Math.round(1000 * time));
    for (const one of scenes) if (one.motion) pose(one.body, one.motion, time);
    draw();
  }
  const SECONDS = 6;
  function tick(now) {
    if (started === null) return;
    moveTo((now - started) / 1000 / SECONDS);
    if (time >= 1) pause(); else requestAnimationFrame(tick);
  }
  function pause() {
    started = null;
    play.textContent = "Play";
  }
  play.addEventListener("click", () => {
    if (started !== null) return pause();
    started = performance.now() - (time >= 1 ? 0 : time) * 1000 * SECONDS;
    play.textContent = "Pause";
    requestAnimationFrame(tick);
  });
  slider.addEventListener("input", () => { pause(); moveTo(Number(slider.value) / 1000); });

  const shown = (label, part, checked) => {
    const box = element("input", {type: "checkbox"});
    box.checked = checked;
    const apply = () => { scenes.forEach(one => { if (one[part]) one[part].group.visible = box.checked; }); draw(); };
    box.addEventListener("change", apply);
    return {label: element("label", {}, box, label), apply};
  };
  const toggles = [shown("start (green)", "start", true), shown(data.goals.length > 1 ? "goals (orange)" : "goal (orange)", "goal", true)];
  if (data.motions.some(motion => motion.collision !== undefined)) toggles.push(shown("collision (red)", "hit", true));
  const views = {"from behind": [-1, -0.9, 0.8], "from ahead": [1, -0.6, 0.5], "from the side": [0, -1, 0.1],
                 "from above": [-0.01, 0, 1]};
  const buttons = Object.entries(views).map(([name, direction]) => {
    const button = element("button", {type: "button"}, name);
    button.addEventListener("click", () => { look(direction); draw(); });
    return button;
  });
  // What the mouse does, by keys: of the camera about its target.
  function turn(sideways, upwards) {
    const offset = new THREE.Spherical().setFromVector3(
      camera.position.clone().sub(controls.target).applyAxisAngle(new THREE.Vector3(1, 0, 0), -Math.PI / 2));
    offset.theta += 0.1 * sideways;
    offset.phi -= 0.1 * upwards;
    offset.makeSafe();
    camera.position.setFromSpherical(offset).applyAxisAngle(new THREE.Vector3(1, 0, 0), Math.PI / 2).add(controls.target);
  }
  function move(sideways, upwards) {
    const step = new THREE.Vector3(sideways, upwards, 0).applyQuaternion(camera.quaternion)
      .multiplyScalar(0.05 * camera.position.distanceTo(controls.target));
    camera.position.add(step);
    controls.target.add(step);
  }
  const NEARER = 1 / 1.15;
  const approach = factor => camera.position.sub(controls.target).multiplyScalar(factor).add(controls.target);
  canvas.addEventListener("keydown", event => {
    if (event.ctrlKey || event.altKey || event.metaKey) return;  // the browser's own
    const direction = {ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, 1], ArrowDown: [0, -1]}[event.key];
    if (direction) (event.shiftKey ? move : turn)(...direction);
    else if (event.key === "+" || event.key === "=") approach(NEARER);
    else if (event.key === "-") approach(1 / NEARER);
    else return;
    event.preventDefault();
    controls.update();
    draw();
  });

  const moves = data.motions.length > 0;
  container.append(
    element("div", {class: "captions"}, ...data.motions.map(motion => element("p", {},
      [`${motion.name} path`, ...motion.remarks].join("; ")))),
    canvas,
    element("div", {class: "controls"}, ...(moves ? [play, slider] : [element("p", {class: "note"}, "There is no path.")]),
            ...toggles.map(toggle => toggle.label), ...buttons),
    element("p", {class: "note"}, (moves ? "Blue: the robot on its way; line: the way of its tip. " : "Blue: the robot. ") + HOW_TO_MOVE));
  canvas.classList.add("view");
  container.classList.add("viewer");

  function rebuild() {
    scenes = (moves ? data.motions : [null]).map(makeScene);
    bounds = new THREE.Box3().setFromObject(scenes[0].scene).getBoundingSphere(new THREE.Sphere());
    toggles.forEach(toggle => toggle.apply());
    moveTo(time);
  }
  rebuild();
  if (seenFrom) {
    camera.position.copy(seenFrom.position);
    controls.target.copy(seenFrom.target);
    fitted = seenFrom.fitted;
    controls.update();
  } else {
    look(views["from behind"]);
  }
  controls.addEventListener("change", draw);
  // Of WebGL paper would show what was drawn before it was asked for.
  const sheet = element("canvas", {class: "sheet"});
  canvas.after(sheet);
  const stopListening = theme.onChange(() => {
    rebuild();
    if (!theme.isForPaper()) return;
    [sheet.width, sheet.height] = [canvas.width, canvas.height];
    sheet.getContext("2d").drawImage(canvas, 0, 0);
  });
  addEventListener("resize", draw);
  draw();

  // Browsers keep few WebGL contexts alive.
  function dispose() {
    pause();
    stopListening();
    removeEventListener("resize", draw);
    controls.dispose();
    renderer.dispose();
    renderer.forceContextLoss();
    container.replaceChildren();
  }
  const seen = () => ({position: camera.position.clone(), target: controls.target.clone(), fitted});
  return {moveTo, play: () => { if (started === null) play.click(); }, canvas, seenFrom: seen, dispose};
}
