// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

// The page: what the visitor chooses, runs of the matcher, and what they give

import { codeOf } from './code.mjs';
import { Controls } from './controls.mjs';
import { Cancelled, MatcherClient } from './matcher_client.mjs';
import { colorRange, drawConfidence, drawDisparity, drawImage, drawScale } from './picture.mjs';
import { Video } from './video.mjs';

const get = id => document.getElementById(id);
const scale = 16; // of the disparities
const builtIn = { focal: 620, baseline: 0.19, numDisparities: 64 };

const client = new MatcherClient();
let controls = null,
    documentation = null;
let images = { left: null, right: null }; // { name, image }
let result = null,
    view = 'disparity',
    cloud = null;
let runs = 0; // so that a late answer is not taken for the last one

// Messages

function showError(error) {
    if (error instanceof Cancelled) return;
    const message = get('message');
    message.textContent = error.message;
    message.hidden = false;
    setBusy(false);
    showStatus(result ? 'The map below is that of the last pair.' : '');
}

function clearError() {
    get('message').hidden = true;
}

function showStatus(text) {
    get('status').textContent = text;
}

function setBusy(isBusy) {
    get('stage').setAttribute('aria-busy', isBusy);
    clearTimeout(setBusy.timer);
    if (!isBusy) get('busy').hidden = true;
    else
        // shorter runs do without
        setBusy.timer = setTimeout(() => {
            get('busy').hidden = false;
        }, 150);
}

// Results

const inPixels = (value, digits = 1) => (value / scale).toFixed(digits);

function fitStage(width, height) {
    get('stage').style.setProperty('--ratio', `${width} / ${height}`);
}

function drawMap() {
    if (!result) return;
    const threshold = Number(get('threshold').value);
    const map = get('map');
    if (view === 'confidence') drawConfidence(map, result, { threshold });
    else drawDisparity(map, result, { range: result.range, invalid: result.invalid, threshold });
    map.setAttribute('aria-label', view === 'confidence' ? 'Confidence' : 'Disparity map');
}

function showScale() {
    const isConfidence = view === 'confidence';
    get('scale-low').textContent = isConfidence ? '0' : inPixels(result.range[0]);
    get('scale-high').textContent = isConfidence ? '255' : inPixels(result.range[1]);
    get('scale-unit').textContent = isConfidence ? 'confidence' : 'pixels, far to near';
    drawScale(get('scale-bar'), isConfidence);
}

function camera() {
    return {
        focal: Number(get('focal').value) || result.width,
        baseline: Number(get('baseline').value) || 1,
        threshold: Number(get('threshold').value),
    };
}

async function showCloud() {
    get('points').hidden = view !== 'points';
    get('pictures').hidden = view === 'points';
    if (view !== 'points' || !result) return;
    try {
        if (!cloud) {
            const { PointCloud } = await import('./point_cloud.mjs');
            cloud ??= new PointCloud(get('points'));
        }
        cloud.show(result, camera());
    } catch (error) {
        showError(error);
    }
}

function addFinding(term, text) {
    const list = get('found');
    list.append(
        Object.assign(document.createElement('dt'), { textContent: term }),
        Object.assign(document.createElement('dd'), { textContent: text }),
    );
}

function showFindings() {
    const { noise, noiseThreshold, rows, light, ratios, times } = result.found;
    get('found').replaceChildren();
    const largest = Math.max(
        ...rows.model.map((value, i) => Math.abs(value) * [1, result.width / 2, result.height / 2, 0, 0][i]),
    );
    const [offset] = rows.model,
        [gain] = light.model;
    addFinding(
        'Rows',
        rows.moved
            ? `moved by ${offset.toFixed(2)} pixels in the centre, up to ${largest.toFixed(2)}`
            : rows.sought
              ? 'fit, not moved'
              : 'not looked at',
    );
    addFinding(
        'Light',
        light.changed
            ? `of the right image changed, gain ${gain.toFixed(2)}`
            : light.sought
              ? 'agrees, not changed'
              : 'not looked at',
    );
    addFinding(
        'Noise',
        noise === 0
            ? 'not measured'
            : `${noise.toFixed(1)} of 255 levels` +
                  (noiseThreshold > 0 && noise >= noiseThreshold ? ', so both images were smoothed' : ''),
    );
    addFinding(
        'Searched',
        ratios
            .map((ratio, layer) => [ratio, layer])
            .filter(([ratio]) => ratio > 0)
            .map(([ratio, layer]) => `${(100 * ratio).toFixed(0)} % in layer ${layer}`)
            .join(', ') + ' of the range',
    );
    addFinding(
        'Range',
        `${inPixels(result.smallest)} to ${inPixels(result.largest)} pixels` +
            (result.rejected ? `, ${((100 * result.rejected) / result.disparity.length).toFixed(1)} % rejected` : ''),
    );

    const longest = Math.max(...times.milliseconds);
    get('times').replaceChildren(
        ...times.stages.map((stage, i) => {
            const item = document.createElement('li'),
                time = times.milliseconds[i];
            item.style.setProperty('--share', time / longest);
            item.append(
                Object.assign(document.createElement('span'), { textContent: stage }),
                Object.assign(document.createElement('b'), { textContent: `${time.toFixed(1)} ms` }),
            );
            return item;
        }),
    );
}

function describe(disparity, invalid) {
    let smallest = Infinity,
        largest = -Infinity,
        rejected = 0;
    for (const value of disparity)
        if (value === invalid) {
            rejected++;
        } else {
            smallest = Math.min(smallest, value);
            largest = Math.max(largest, value);
        }
    return rejected === disparity.length ? { smallest: 0, largest: 0, rejected } : { smallest, largest, rejected };
}

function takeResult(answer, settings, left, isVideo = false) {
    const invalid = (settings.minDisparity - 1) * scale;
    const range = colorRange(answer, invalid);
    if (isVideo && result?.isVideo)
        // colours that do not flicker
        range.forEach((value, i) => {
            range[i] = 0.9 * result.range[i] + 0.1 * value;
        });
    result = { ...answer, invalid, left, settings, isVideo, range, ...describe(answer.disparity, invalid) };
    document.body.classList.add('has-result');
    if (!get('focal').value) get('focal').placeholder = result.width;
    drawMap();
    showScale();
    showFindings();
    if (view === 'points') showCloud();
}

// Runs

async function match() {
    if (video.isOpen) return restartVideo();
    if (!images.left || !images.right || !controls) return;
    const run = ++runs,
        { settings } = controls,
        left = images.left.image;
    showCode();
    clearError();
    setBusy(true);
    showStatus('Matching…');
    try {
        const answer = await client.match(settings);
        if (run !== runs) return;
        takeResult(answer, settings, left);
        showStatus(
            `${result.width} × ${result.height} pixels, ${settings.numDisparities} disparities, ` +
                `${settings.preset}: ${answer.milliseconds.toFixed(0)} ms` +
                (run === 1 ? ' (the first run also compiles the matcher)' : ''),
        );
        document.body.dataset.run = run;
        setBusy(false);
    } catch (error) {
        if (run === runs) showError(error);
    }
}

function matchSoon() {
    showCode();
    clearTimeout(matchSoon.timer);
    matchSoon.timer = setTimeout(match, 120);
}

function showCode() {
    const { cpp, python } = codeOf(controls.settings, documentation);
    get('code-cpp').textContent = cpp;
    get('code-python').textContent = python;
}

// Images

const sizeOf = ({ width, height }) => `${width} × ${height}`;

function drawThumbnail(side) {
    const canvas = get(`thumb-${side}`),
        chosen = images[side],
        context = canvas.getContext('2d');
    context.clearRect(0, 0, canvas.width, canvas.height);
    get(`name-${side}`).textContent = chosen ? chosen.name : 'choose';
    if (!chosen) return;
    const whole = document.createElement('canvas');
    drawImage(whole, chosen.image);
    const factor = Math.max(canvas.width / whole.width, canvas.height / whole.height);
    const width = whole.width * factor,
        height = whole.height * factor;
    context.imageSmoothingQuality = 'high';
    context.drawImage(whole, (canvas.width - width) / 2, (canvas.height - height) / 2, width, height);
}

async function setImages(chosen, numDisparities) {
    const { left, right } = chosen;
    if (left && right && (left.image.width !== right.image.width || left.image.height !== right.image.height))
        throw new Error(
            `The images have different sizes: ${left.name} has ${sizeOf(left.image)} pixels, ` +
                `${right.name} ${sizeOf(right.image)}.`,
        );
    if (left && right && left.image.data.BYTES_PER_ELEMENT !== right.image.data.BYTES_PER_ELEMENT)
        throw new Error('One of the images has 8 bits, and the other one 16. Both must have the same.');
    closeVideo();
    const isOtherSize = images.left?.image.width !== left?.image.width;
    images = chosen;
    drawThumbnail('left');
    drawThumbnail('right');
    if (!left || !right)
        throw new Error(
            `Only the ${left ? 'left' : 'right'} image is there. ` + `Choose the ${left ? 'right' : 'left'} one, too.`,
        );
    if (isOtherSize || numDisparities)
        // as samples/hdp_stereo_match does
        controls.suggestRange(numDisparities ?? Math.max(Math.ceil(left.image.width / 5 / 16) * 16, 16));
    fitStage(left.image.width, left.image.height);
    drawImage(get('left'), left.image);
    await client.setPair(left.image, right.image);
    await match();
}

function split({ name, image }) {
    const { width, height, data } = image,
        half = width >> 1,
        channels = data.length / (width * height);
    const part = first => {
        const cut = new data.constructor(channels * half * height);
        for (let y = 0; y < height; y++)
            cut.set(
                data.subarray(channels * (y * width + first), channels * (y * width + first + half)),
                channels * y * half,
            );
        return { width: half, height, data: cut };
    };
    return {
        left: { name: `${name}, left half`, image: part(0) },
        right: { name: `${name}, right half`, image: part(width - half) },
    };
}

// left.png before right.png, L before R, 0 before 1
function inOrder(files) {
    const { compare } = new Intl.Collator('en', { numeric: true });
    return [...files].sort((a, b) => compare(a.name, b.name));
}

async function decode(file) {
    return { name: file.name, image: await client.decode(file) };
}

async function openFiles(files) {
    const [first, second, third] = inOrder(files);
    if (!first) return;
    if (third) throw new Error(`These are ${files.length} files. Choose two images, or one with both side by side.`);
    if (first.type.startsWith('video/')) return openVideo(() => video.openFile(first));
    get('focal').value = '';
    if (second) return setImages({ left: await decode(first), right: await decode(second) });
    const whole = await decode(first),
        { width, height } = whole.image;
    if (width < 1.9 * height)
        throw new Error(`${first.name} is only one image. Choose two, or one with both side by side.`);
    return setImages(split(whole));
}

async function openSide(side, file) {
    if (file) await setImages({ ...images, [side]: await decode(file) });
}

async function openBuiltIn() {
    const files = await Promise.all(
        ['left', 'right'].map(async side => {
            const response = await fetch(`pair/${side}.png`);
            if (!response.ok) throw new Error('The built-in pair cannot be loaded.');
            return new File([await response.blob()], `${side}.png`);
        }),
    );
    const [left, right] = await Promise.all(files.map(decode));
    get('focal').value = builtIn.focal;
    get('baseline').value = builtIn.baseline;
    await setImages({ left, right }, builtIn.numDisparities);
}

// Video

const video = new Video({
    async match(frame, isWanted) {
        const answer = await client.frame(frame),
            { settings } = video;
        if (!isWanted()) return;
        fitStage(answer.left.width, answer.left.height);
        drawImage(get('left'), answer.left);
        takeResult(answer, settings, answer.left, true);
        showStatus(
            `${result.width} × ${result.height} pixels, ${settings.numDisparities} disparities, ` +
                `${settings.preset}: ${answer.milliseconds.toFixed(0)} ms per frame`,
        );
        document.body.dataset.frames = Number(document.body.dataset.frames ?? 0) + 1;
    },
    report(framesPerSecond) {
        get('fps').textContent = `${framesPerSecond.toFixed(1)} frames per second`;
    },
    fail(error) {
        closeVideo();
        showError(error);
    },
});

async function openVideo(open) {
    await open();
    const [width, height] = video.frameSize;
    if (width < 1.9 * height) {
        video.close();
        throw new Error(`The video has ${width} × ${height} pixels: its frames do not show two images side by side.`);
    }
    runs++;
    get('video-bar').hidden = false;
    get('pause').textContent = 'Pause';
    document.body.classList.add('is-video');
    controls.suggestRange(Math.max(Math.ceil(width / 2 / 5 / 16) * 16, 16));
    clearError();
    await restartVideo();
}

async function restartVideo() {
    showCode();
    video.generation++; // the frame that is being matched is the last one
    const { settings } = controls;
    settings.changes.useTemporalPrediction = get('temporal').checked;
    video.settings = settings;
    try {
        await client.setVideo(settings);
        clearError();
        setBusy(false);
        video.run();
    } catch (error) {
        showError(error);
    }
}

function closeVideo() {
    if (!video.isOpen) return;
    video.close();
    client.setVideo(null);
    get('video-bar').hidden = true;
    document.body.classList.remove('is-video');
}

// Downloads

async function download(kind) {
    const { width, height, disparity, confidence, invalid, left } = result;
    const bytes = await client.encode({
        kind,
        result: { width, height, disparity, confidence, invalid, left, ...camera() },
    });
    const link = document.createElement('a');
    link.href = URL.createObjectURL(new Blob([bytes]));
    link.download = `disparity.${kind}`;
    link.click();
    setTimeout(() => URL.revokeObjectURL(link.href), 10000);
}

// What the visitor does

// A sentence stays until something else is tried.
const attempt =
    action =>
    (...args) => {
        clearError();
        return Promise.resolve()
            .then(() => action(...args))
            .catch(showError);
    };

function choose(input, action) {
    get(input).value = '';
    get(input).onchange = attempt(() => action([...get(input).files]));
    get(input).click();
}

function setView(chosen) {
    view = chosen;
    for (const button of document.querySelectorAll('[data-view]'))
        button.setAttribute('aria-pressed', button.dataset.view === view);
    if (result && view !== 'points') {
        drawMap();
        showScale();
    }
    return showCloud();
}

function setWipe() {
    get('pictures').style.setProperty('--wipe', `${get('wipe').value}%`);
    get('wipe').setAttribute('aria-valuetext', `${Math.round(get('wipe').value)} % left image`);
}

function readOut(event) {
    const output = get('readout'),
        box = get('left').getBoundingClientRect();
    const x = Math.floor(((event.clientX - box.left) / box.width) * (result?.width ?? 0));
    const y = Math.floor(((event.clientY - box.top) / box.height) * (result?.height ?? 0));
    output.hidden = !result || x < 0 || y < 0 || x >= result.width || y >= result.height;
    if (output.hidden) return;
    const i = y * result.width + x,
        value = result.disparity[i],
        { focal, baseline } = camera();
    const depth =
        get('focal').value && value > 0 ? `, depth ${((focal * baseline * scale) / value).toPrecision(3)}` : '';
    output.textContent =
        `(${x}, ${y})  ` +
        (value === result.invalid
            ? 'rejected'
            : `${inPixels(value, 2)} px${depth}, confidence ${result.confidence[i]}`);
}

function listen() {
    get('choose-pair').onclick = () => choose('file-pair', openFiles);
    get('choose-left').onclick = () => choose('file-left', ([file]) => openSide('left', file));
    get('choose-right').onclick = () => choose('file-right', ([file]) => openSide('right', file));
    get('built-in').onclick = attempt(openBuiltIn);
    get('open-video').onclick = () => choose('file-video', ([file]) => file && openVideo(() => video.openFile(file)));
    get('open-camera').onclick = attempt(() => openVideo(() => video.openCamera()));
    get('swap').onclick = attempt(() => setImages({ left: images.right, right: images.left }));
    get('temporal').onchange = attempt(restartVideo);
    get('pause').onclick = attempt(async () => {
        await video.togglePause();
        get('pause').textContent = video.isPaused ? 'Continue' : 'Pause';
    });
    get('stop-video').onclick = attempt(async () => {
        closeVideo();
        result = null;
        await (images.left && images.right ? setImages(images) : openBuiltIn());
    });
    get('cancel').onclick = () => {
        runs++;
        client.cancel();
        setBusy(false);
        showStatus('Cancelled.');
    };
    for (const button of document.querySelectorAll('[data-view]'))
        button.onclick = attempt(() => setView(button.dataset.view));
    for (const button of document.querySelectorAll('[data-download]'))
        button.onclick = attempt(() => result && download(button.dataset.download));
    for (const button of document.querySelectorAll('[data-copy]'))
        button.onclick = attempt(async () => {
            await navigator.clipboard.writeText(get(button.dataset.copy).textContent);
            button.textContent = 'Copied';
            setTimeout(() => {
                button.textContent = 'Copy';
            }, 1500);
        });
    get('wipe').oninput = setWipe;
    get('pictures').onpointermove = readOut;
    get('pictures').onpointerleave = () => {
        get('readout').hidden = true;
    };
    get('threshold').oninput = () => {
        get('threshold-value').textContent = get('threshold').value;
        drawMap();
    };
    get('threshold').onchange = attempt(showCloud);
    get('focal').onchange = get('baseline').onchange = attempt(showCloud);

    document.ondragover = event => {
        event.preventDefault();
        document.body.classList.add('is-dropping');
    };
    document.ondragleave = event => {
        if (!event.relatedTarget) document.body.classList.remove('is-dropping');
    };
    document.ondrop = event => {
        event.preventDefault();
        document.body.classList.remove('is-dropping');
        attempt(openFiles)([...event.dataTransfer.files]);
    };
}

async function start() {
    drawScale(get('scale-bar'), false);
    setWipe();
    try {
        const started = await client.start();
        documentation = started.documentation;
        controls = new Controls(started, matchSoon);
        get('engine').textContent =
            `OpenCV ${started.version}, ` + `${started.threads > 1 ? `${started.threads} threads` : 'one thread'}.`;
    } catch (error) {
        return showError(
            new Error(
                `The matcher cannot be loaded: ${error.message}. It needs a browser with SIMD and exceptions of ` +
                    'WebAssembly, of 2023 or later.',
            ),
        );
    }
    listen();
    await attempt(openBuiltIn)();
}

start();
