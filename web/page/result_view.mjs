// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

// The last map as the visitor wants to see it: disparities, what is known of each, or points, with the left image beside
// it

import { inPixels, rangeOf, scale } from './disparities.mjs';
import { showFindings } from './findings.mjs';
import { attempt, showError } from './messages.mjs';
import {
    colorRange,
    drawConfidence,
    drawDisparity,
    drawImage,
    drawReasons,
    drawScale,
    drawSigma,
    largestSigma,
} from './picture.mjs';
import { reasonWords, showLegend } from './reasons.mjs';

const get = id => document.getElementById(id);

export class ResultView {
    result = null;

    constructor() {
        for (const button of document.querySelectorAll('[data-view]'))
            button.onclick = attempt(() => this.#choose(button.dataset.view));
        get('wipe').oninput = () => this.#wipe();
        get('pictures').onpointermove = event => this.#readOut(event);
        get('pictures').onpointerleave = () => {
            get('readout').hidden = true;
        };
        get('threshold').oninput = () => {
            get('threshold-value').textContent = get('threshold').value;
            this.#drawMap();
        };
        for (const id of ['threshold', 'focal', 'baseline']) get(id).onchange = attempt(() => this.#showPoints());
        drawScale(get('scale-bar'), false);
        this.#wipe();
    }

    // As far as the visitor has told
    get camera() {
        return {
            focal: Number(get('focal').value) || this.result.width,
            baseline: Number(get('baseline').value) || 1,
            threshold: Number(get('threshold').value),
        };
    }

    showLeft(image) {
        get('stage').style.setProperty('--ratio', `${image.width} / ${image.height}`);
        drawImage(get('left'), image);
    }

    // What the matcher answers for this left image
    show(answer, left, isVideo = false) {
        const invalid = (answer.minDisparity - 1) * scale;
        const range = colorRange(answer, invalid);
        if (isVideo && this.result?.isVideo)
            // colours that do not flicker
            range.forEach((value, i) => {
                range[i] = 0.9 * this.result.range[i] + 0.1 * value;
            });
        this.result = { ...answer, invalid, left, isVideo, range, ...rangeOf(answer.disparity, invalid) };
        document.body.classList.add('has-result');
        if (!get('focal').value) get('focal').placeholder = answer.width;
        this.#drawMap();
        this.#drawScale();
        showFindings(this.result);
        this.#showPoints().catch(showError);
    }

    // Whether frames of a video need what takes time
    get needsWhole() {
        return this.#view === 'sigma' || this.#view === 'reasons';
    }

    #view = 'disparity';
    #cloud = null;

    #choose(view) {
        this.#view = view;
        for (const name of ['confidence', 'sigma']) get(`${name}-note`).hidden = view !== name;
        for (const button of document.querySelectorAll('[data-view]'))
            button.setAttribute('aria-pressed', button.dataset.view === view);
        if (this.result && view !== 'points') {
            this.#drawMap();
            this.#drawScale();
        }
        return this.#showPoints();
    }

    // What the last result has of it: the next frame of a video has the rest.
    get #shown() {
        return this.needsWhole && !this.result.sigma ? 'disparity' : this.#view;
    }

    #drawMap() {
        if (!this.result) return;
        const map = get('map'),
            { range, invalid } = this.result,
            { threshold } = this.camera;
        const [label, drawView] = {
            confidence: ['Confidence', () => drawConfidence(map, this.result, { threshold })],
            sigma: ['Expected error', () => drawSigma(map, this.result, { threshold })],
            reasons: ['Reasons', () => drawReasons(map, this.result)],
        }[this.#shown] ?? ['Disparity map', () => drawDisparity(map, this.result, { range, invalid, threshold })];
        drawView();
        map.setAttribute('aria-label', label);
    }

    #drawScale() {
        const { range } = this.result,
            isOfReasons = this.#shown === 'reasons';
        const [low, high, unit] = {
            confidence: ['0', '255', 'confidence'],
            sigma: ['0', `${largestSigma} and more`, 'pixels'],
        }[this.#shown] ?? [inPixels(range[0]), inPixels(range[1]), 'pixels, far to near'];
        get('scale-low').textContent = low;
        get('scale-high').textContent = high;
        get('scale-unit').textContent = unit;
        drawScale(get('scale-bar'), this.#shown === 'confidence');
        get('scale').hidden = isOfReasons;
        get('legend').hidden = !isOfReasons;
        if (isOfReasons) showLegend(get('legend'), this.result.reasons);
    }

    async #showPoints() {
        get('points').hidden = this.#view !== 'points';
        get('pictures').hidden = this.#view === 'points';
        if (this.#view !== 'points' || !this.result) return;
        if (!this.#cloud) {
            const { PointCloud } = await import('./point_cloud.mjs');
            this.#cloud ??= new PointCloud(get('points'));
        }
        this.#cloud.show(this.result, this.camera);
    }

    #wipe() {
        const { value } = get('wipe');
        get('pictures').style.setProperty('--wipe', `${value}%`);
        get('wipe').setAttribute('aria-valuetext', `${Math.round(value)} % left image`);
    }

    // The pixel under the pointer
    #readOut(event) {
        const output = get('readout'),
            box = get('left').getBoundingClientRect(),
            { width = 0, height = 0, disparity, confidence, sigma, reasons, invalid } = this.result ?? {};
        const x = Math.floor(((event.clientX - box.left) / box.width) * width);
        const y = Math.floor(((event.clientY - box.top) / box.height) * height);
        output.hidden = !(x >= 0 && y >= 0 && x < width && y < height);
        if (output.hidden) return;
        const i = y * width + x,
            value = disparity[i],
            { focal, baseline } = this.camera;
        const depth =
            get('focal').value && value > 0 ? `, depth ${((focal * baseline * scale) / value).toPrecision(3)}` : '';
        const error = sigma ? ` ± ${sigma[i].toFixed(2)}` : '';
        output.textContent =
            `(${x}, ${y})  ` +
            (value !== invalid
                ? `${inPixels(value, 2)}${error} px${depth}, confidence ${confidence[i]}`
                : reasons
                  ? reasonWords[reasons[i]].text
                  : 'rejected');
    }
}
