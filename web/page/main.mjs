// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

// The page: what the visitor chooses, and runs of the matcher

import { codeOf } from './code.mjs';
import { Controls } from './controls.mjs';
import { addSlots, checkKnown, dataOf, keptFor, nothing, readKnown, showKnown, sortFiles } from './known.mjs';
import { MatcherClient } from './matcher_client.mjs';
import { attempt, clearError, setBusy, showError, showStatus } from './messages.mjs';
import { builtIn, checkPair, readBuiltIn, readImage, readPair } from './pair_files.mjs';
import { drawImage } from './picture.mjs';
import { ResultView } from './result_view.mjs';
import { Video } from './video.mjs';

const get = id => document.getElementById(id);

const client = new MatcherClient();
const view = new ResultView();
let controls = null,
    documentation = null;
let images = { left: null, right: null }; // { name, image }
let known = nothing; // of the pair
let runs = 0; // so that a late answer is not taken for the last one

// Runs

const describe = ({ width, height, numDisparities }, { preset }) =>
    `${width} × ${height} pixels, ${numDisparities} disparities, ${preset}`;

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
        if (settings.numDisparities === 0) controls.suggestRange(answer.numDisparities, answer.minDisparity);
        view.show(answer, left);
        showStatus(
            `${describe(answer, settings)}: ${answer.milliseconds.toFixed(0)} ms` +
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
    const { cpp, python } = codeOf(controls.settings, dataOf(video.isOpen ? nothing : known), documentation);
    get('code-cpp').textContent = cpp;
    get('code-python').textContent = python;
}

// Images

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

async function setImages(chosen, chosenKnown, numDisparities) {
    const { left, right } = chosen;
    if (left && right) checkPair(chosen);
    checkKnown(chosenKnown, (left ?? right)?.image);
    const before = closeVideo();
    const isOtherSize = images.left?.image.width !== left?.image.width;
    images = chosen;
    known = chosenKnown;
    showKnown(known);
    drawThumbnail('left');
    drawThumbnail('right');
    if (!left || !right)
        throw new Error(
            `Only the ${left ? 'left' : 'right'} image is there. Choose the ${left ? 'right' : 'left'} one, too.`,
        );
    if (isOtherSize || numDisparities)
        // as samples/hdp_stereo_match does
        controls.suggestRange(numDisparities ?? Math.max(Math.ceil(left.image.width / 5 / 16) * 16, 16));
    else if (before) controls.suggestRange(...before);
    view.showLeft(left.image);
    await client.setPair(left.image, right.image, dataOf(known));
    await match();
}

// What is known, of the pair that is there
async function setKnown(change) {
    const chosen = { ...known, ...change },
        { left, right } = images;
    checkKnown(chosen, (left ?? right)?.image);
    known = chosen;
    showKnown(known);
    if (!left || !right) return;
    await client.setPair(left.image, right.image, dataOf(known));
    await match();
}

const decode = (file, kind) => client.decode(file, kind);

async function openFiles(files) {
    if (files.length === 0) return;
    if (files[0].type.startsWith('video/')) return openVideo(() => video.openFile(files[0]));
    const sorted = sortFiles(files),
        chosen = await readKnown(sorted.known, decode);
    if (sorted.pair.length === 0) return setKnown(chosen);
    const pair = await readPair(sorted.pair, decode);
    get('focal').value = '';
    await setImages(pair, { ...keptFor(known, pair.left.image), ...chosen });
}

async function openSide(side, file) {
    if (!file) return;
    const chosen = await readImage(file, decode);
    await setImages({ ...images, [side]: chosen }, keptFor(known, chosen.image));
}

function swap() {
    const { leftMask, rightMask } = known;
    return setImages(
        { left: images.right, right: images.left },
        { ...nothing, leftMask: rightMask, rightMask: leftMask },
    );
}

async function openBuiltIn() {
    const pair = await readBuiltIn(decode);
    get('focal').value = builtIn.focal;
    get('baseline').value = builtIn.baseline;
    await setImages(pair, keptFor(known, pair.left.image), builtIn.numDisparities);
}

// Video

let stillRange = null; // numDisparities and minDisparity of the pair before the video

const video = new Video({
    async match(frame, isWanted) {
        const answer = await client.frame(frame, view.needsWhole),
            { settings } = video;
        if (!isWanted()) return;
        view.showLeft(answer.left);
        view.show(answer, answer.left, true);
        showStatus(`${describe(answer, settings)}: ${answer.milliseconds.toFixed(0)} ms per frame`);
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
    stillRange ??= [controls.numDisparities, controls.minDisparity];
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

// Returns the range before it was opened, if it was.
function closeVideo() {
    const before = stillRange;
    stillRange = null;
    if (!video.isOpen) return before;
    video.close();
    client.setVideo(null);
    get('video-bar').hidden = true;
    document.body.classList.remove('is-video');
    return before;
}

// Downloads

async function download(kind) {
    if (!view.result) return;
    if (kind === 'sigma' && !view.result.sigma)
        throw new Error('A video has expected errors while they are shown: choose “Expected error” above the picture.');
    const { width, height, disparity, confidence, sigma, invalid, left, model } = view.result;
    const bytes = await client.encode({
        kind,
        result: { width, height, disparity, confidence, sigma, invalid, left, model, ...view.camera },
    });
    const link = document.createElement('a');
    link.href = URL.createObjectURL(new Blob([bytes]));
    link.download = { sigma: 'sigma.pfm', findings: 'findings.yml' }[kind] ?? `disparity.${kind}`;
    link.click();
    setTimeout(() => URL.revokeObjectURL(link.href), 10000);
}

// What the visitor does

function choose(input, action) {
    get(input).value = '';
    get(input).onchange = attempt(() => action([...get(input).files]));
    get(input).click();
}

function listen() {
    get('choose-pair').onclick = () => choose('file-pair', openFiles);
    get('choose-left').onclick = () => choose('file-left', ([file]) => openSide('left', file));
    get('choose-right').onclick = () => choose('file-right', ([file]) => openSide('right', file));
    get('built-in').onclick = attempt(openBuiltIn);
    get('open-video').onclick = () => choose('file-video', ([file]) => file && openVideo(() => video.openFile(file)));
    get('open-camera').onclick = attempt(() => openVideo(() => video.openCamera()));
    get('swap').onclick = attempt(swap);
    addSlots(
        (slot, accept) => {
            get('file-known').accept = accept;
            choose('file-known', async ([file]) => file && setKnown(await readKnown({ [slot]: file }, decode)));
        },
        attempt(slot => setKnown({ [slot]: null })),
    );
    get('known-sigma').onchange = attempt(() => setKnown({}));
    get('temporal').onchange = attempt(restartVideo);
    get('pause').onclick = attempt(async () => {
        await video.togglePause();
        get('pause').textContent = video.isPaused ? 'Continue' : 'Pause';
    });
    get('stop-video').onclick = attempt(() => (images.left && images.right ? setImages(images, known) : openBuiltIn()));
    get('cancel').onclick = () => {
        runs++;
        client.cancel();
        setBusy(false);
        showStatus('Cancelled.');
    };
    for (const button of document.querySelectorAll('[data-download]'))
        button.onclick = attempt(() => download(button.dataset.download));
    for (const button of document.querySelectorAll('[data-copy]'))
        button.onclick = attempt(async () => {
            await navigator.clipboard.writeText(get(button.dataset.copy).textContent);
            button.textContent = 'Copied';
            setTimeout(() => {
                button.textContent = 'Copy';
            }, 1500);
        });
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
    try {
        const started = await client.start();
        documentation = started.documentation;
        controls = new Controls(started, matchSoon);
        get('engine').textContent =
            `OpenCV ${started.version}, ${started.threads > 1 ? `${started.threads} threads` : 'one thread'}.`;
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
