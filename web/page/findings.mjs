// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

// What the matcher found in a pair, and how long its stages took

import { inPixels } from './disparities.mjs';

const get = id => document.getElementById(id);

function addFinding(term, text) {
    const list = get('found');
    list.append(
        Object.assign(document.createElement('dt'), { textContent: term }),
        Object.assign(document.createElement('dd'), { textContent: text }),
    );
}

// What seems to be wrong with a pair, by its rows; null if nothing does
export function pairProblem({ rows }) {
    if (!rows.sought) return null;
    if (rows.error === 0)
        return (
            'Hardly a corner of the left image was found in the right one. Are the two swapped? Is the pair rectified, ' +
            'which means that a point is in the same row of both? Do the disparities begin and end where they should?'
        );
    const off = Math.abs(rows.model[0]);
    const hint = 'Are the images swapped, or not rectified? A point should be in the same row of both.';
    if (off > 3) return `The rows of the right image are off by ${off.toFixed(1)} pixels. ${hint}`;
    if (rows.error > 1) return `Corners are ${rows.error.toFixed(1)} pixels off their rows in the right image. ${hint}`;
    return null;
}

export function showFindings(result) {
    const { noise, noiseThreshold, rows, light, range, ratios, times } = result.found;
    const problem = pairProblem(result.found);
    get('problem').textContent = problem ?? '';
    get('problem').hidden = !problem;
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
                  (noiseThreshold > 0 && noise > noiseThreshold ? ', so both images were smoothed' : ''),
    );
    addFinding(
        'Searched',
        ratios
            .map((ratio, layer) => [ratio, layer])
            .filter(([ratio]) => ratio > 0)
            .map(([ratio, layer]) => `${(100 * ratio).toFixed(0)} % in layer ${layer}`)
            .join(', ') + ' of the range',
    );
    if (range.sought) {
        const { minDisparity, numDisparities } = result;
        addFinding('Range', `${minDisparity} to ${minDisparity + numDisparities - 1} pixels, found`);
    }
    addFinding(
        'Disparities',
        `${inPixels(result.smallest)} to ${inPixels(result.largest)} pixels` +
            (result.rejected ? `, none in ${((100 * result.rejected) / result.disparity.length).toFixed(1)} %` : ''),
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
