// Flips through pictures: by key, by a slider between two, or as their difference. The first is the reference. Light is taken
// back from the 8 bits of the pictures: v is sRGB of t = c/(c+1).
(() => {
  const viewer = document.getElementById('viewer'), stage = viewer.querySelector('.stage');
  const canvas = viewer.querySelector('canvas'), context = canvas.getContext('2d', {willReadFrequently: true});
  const status = viewer.querySelector('.status'), images = [...viewer.querySelectorAll('img')];
  const state = {mode: 'flip', chosen: 1, reference: false, split: 0.5, zoom: 1, stops: 0, gain: 4};
  let pixels = [];

  const decode = v => v <= 0.04045 ? v / 12.92 : ((v + 0.055) / 1.055) ** 2.4;
  const encode = t => t <= 0.0031308 ? 12.92 * t : 1.055 * t ** (1 / 2.4) - 0.055;
  const light = v => { const t = decode(Math.min(v, 254.5) / 255); return t / (1 - t); };
  function exposed() {
    const table = new Uint8Array(256);
    for (let v = 0; v < 256; ++v) {
      const c = light(v) * 2 ** state.stops;
      table[v] = state.stops === 0 ? v : Math.round(255 * encode(c / (c + 1)));
    }
    return table;
  }

  function draw() {
    const {width, height} = canvas, table = exposed(), out = context.createImageData(width, height);
    const reference = pixels[0], chosen = pixels[state.chosen], data = out.data;
    const edge = Math.round(state.split * width);
    for (let i = 0, x = 0; i < data.length; i += 4, x = x + 1 === width ? 0 : x + 1) {
      for (let c = i; c < i + 3; ++c) {
        if (state.mode === 'difference')
          data[c] = Math.min(255, state.gain * Math.abs(table[chosen[c]] - table[reference[c]]));
        else if (state.mode === 'split' ? x < edge : state.reference)
          data[c] = table[reference[c]];
        else
          data[c] = table[chosen[c]];
      }
      data[i + 3] = 255;
    }
    if (state.mode === 'split' && edge > 0 && edge < width)
      for (let y = 0; y < height; ++y) data.set([255, 210, 0], 4 * (y * width + edge));
    context.putImageData(out, 0, 0);
    canvas.style.width = `${width * state.zoom}px`;
    viewer.dataset.mode = state.mode;
    viewer.dataset.state = JSON.stringify(state);
    for (const button of viewer.querySelectorAll('[data-mode]')) button.classList.toggle('on', button.dataset.mode === state.mode);
    images.forEach((image, i) => viewer.querySelector(`[data-picture="${i}"]`).classList.toggle('on',
      state.mode === 'flip' ? i === (state.reference ? 0 : state.chosen) : i === 0 || i === state.chosen));
    viewer.querySelector('.stops').textContent = `exposure ${state.stops > 0 ? '+' : ''}${state.stops}`;
    viewer.querySelector('.zoom').textContent = `zoom ${+state.zoom.toFixed(2)}`;
    viewer.querySelector('.gain').textContent = `difference × ${state.gain}`;
  }

  function choose(picture) {
    if (picture > 0) state.chosen = picture;
    state.reference = picture === 0;
  }
  function zoomBy(factor) {
    const middle = [stage.scrollLeft + stage.clientWidth / 2, stage.scrollTop + stage.clientHeight / 2];
    const before = state.zoom;
    state.zoom = Math.min(64, Math.max(1 / 16, state.zoom * factor));
    canvas.style.width = `${canvas.width * state.zoom}px`;
    stage.scrollLeft = middle[0] * state.zoom / before - stage.clientWidth / 2;
    stage.scrollTop = middle[1] * state.zoom / before - stage.clientHeight / 2;
  }
  const actions = {
    ' ': () => { state.reference = !state.reference; },
    f: () => { state.mode = 'flip'; },
    s: () => { state.mode = 'split'; },
    d: () => { state.mode = 'difference'; },
    g: () => { state.gain = state.gain === 64 ? 1 : state.gain * 4; },
    '+': () => zoomBy(2), '=': () => zoomBy(2), '-': () => zoomBy(0.5),
    ']': () => { ++state.stops; }, '[': () => { --state.stops; },
    ArrowRight: () => choose((state.reference ? 0 : state.chosen) + 1 < images.length ? (state.reference ? 0 : state.chosen) + 1 : 0),
    ArrowLeft: () => choose(((state.reference ? 0 : state.chosen) + images.length - 1) % images.length),
  };
  viewer.addEventListener('keydown', event => {
    if (event.ctrlKey || event.metaKey || event.altKey) return;
    const key = event.key.length === 1 ? event.key.toLowerCase() : event.key;
    if (/^[0-9]$/.test(key) && +key < images.length) choose(+key);
    else if (actions[key]) actions[key]();
    else return;
    event.preventDefault();
    draw();
  });
  viewer.addEventListener('click', event => {
    const {picture, key} = event.target.closest('button')?.dataset ?? {};
    if (picture !== undefined) choose(+picture);
    else if (key !== undefined) actions[key]();
    else return;
    draw();
    viewer.focus({preventScroll: true});
  });

  function place(event) {
    const box = canvas.getBoundingClientRect();
    return [(event.clientX - box.left) / box.width, (event.clientY - box.top) / box.height];
  }
  function tell(event) {
    const [u, v] = place(event), x = Math.floor(u * canvas.width), y = Math.floor(v * canvas.height);
    if (x < 0 || y < 0 || x >= canvas.width || y >= canvas.height) return;
    const color = data => [0, 1, 2].map(c => light(data[4 * (y * canvas.width + x) + c]).toPrecision(2)).join(' ');
    status.textContent = `(${x}, ${y})   ${images[0].alt}: ${color(pixels[0])}   ${images[state.chosen].alt}: ${color(pixels[state.chosen])}`;
  }
  let dragged = null;
  canvas.addEventListener('pointerdown', event => {
    dragged = {x: event.clientX, y: event.clientY, left: stage.scrollLeft, top: stage.scrollTop};
    try { canvas.setPointerCapture(event.pointerId); } catch { /* a pointer that a script made up */ }
    viewer.focus({preventScroll: true});
    if (state.mode === 'split') { state.split = place(event)[0]; draw(); }
    event.preventDefault();
  });
  canvas.addEventListener('pointermove', event => {
    tell(event);
    if (!dragged) return;
    if (state.mode === 'split') {
      state.split = Math.min(1, Math.max(0, place(event)[0]));
      draw();
    } else {
      stage.scrollLeft = dragged.left + dragged.x - event.clientX;
      stage.scrollTop = dragged.top + dragged.y - event.clientY;
    }
  });
  for (const end of ['pointerup', 'pointercancel']) canvas.addEventListener(end, () => { dragged = null; });
  stage.addEventListener('wheel', event => {
    if (!event.ctrlKey) return;
    event.preventDefault();
    zoomBy(event.deltaY < 0 ? 2 : 0.5);
    draw();
  }, {passive: false});

  Promise.all(images.map(image => image.decode())).then(() => {
    [canvas.width, canvas.height] = [images[0].naturalWidth, images[0].naturalHeight];
    pixels = images.map(image => {
      context.drawImage(image, 0, 0);
      return context.getImageData(0, 0, canvas.width, canvas.height).data;
    });
    const fit = stage.clientWidth / canvas.width;
    state.zoom = fit < 1 ? fit : Math.min(8, Math.floor(fit));
    draw();
  });
})();
