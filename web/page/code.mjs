// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

// The lines of C++ and Python that give the map of the page

import { strategies } from './controls.mjs';

function valueInCode(name, value, { parameters, enumerations }, scope, isPython) {
    const parameter = parameters.find(p => p.name === name);
    if (!parameter) return null;
    const found = Object.entries(enumerations).find(
        ([title]) => parameter.kind === 'int' && parameter.method.endsWith(title),
    );
    if (found) return `${scope}${found[1].find(option => option.value === value).name}`;
    if (parameter.kind === 'bool') return isPython ? (value ? 'True' : 'False') : String(value);
    return String(value);
}

function setters(settings, documentation, scope, call, isPython) {
    return Object.entries(settings.changes)
        .map(([name, value]) => {
            const strategy = strategies.find(s => name === 'treeStrategy' && s.name === value);
            const [method, argument] = strategy
                ? ['TreeStrategy', `${isPython ? 'hdpstereo.' : 'cv::stereo::'}${strategy.factory}()`]
                : [
                      documentation.parameters.find(p => p.name === name).method,
                      valueInCode(name, value, documentation, scope, isPython),
                  ];
            return `${call}set${method}(${argument})${isPython ? '' : ';'}\n`;
        })
        .join('');
}

export function codeOf(settings, documentation) {
    const { minDisparity, numDisparities, preset } = settings;
    const cpp =
        'using cv::stereo::HDPTreeMatcher;\n' +
        'auto matcher = HDPTreeMatcher::create(\n' +
        `    ${minDisparity}, ${numDisparities}, HDPTreeMatcher::PRESET_${preset});\n` +
        setters(settings, documentation, 'HDPTreeMatcher::', 'matcher->', false) +
        'cv::Mat disparity;\n' +
        'matcher->compute(left, right, disparity); // 16 * disparity';
    const python =
        'import hdpstereo\n' +
        'matcher = hdpstereo.HDPTreeMatcher.create(\n' +
        `    ${minDisparity}, ${numDisparities}, hdpstereo.HDPTreeMatcher.PRESET_${preset})\n` +
        setters(settings, documentation, 'hdpstereo.HDPTreeMatcher.', 'matcher.', true) +
        'disparity = matcher.compute(left, right)  # 16 * disparity';
    return { cpp, python };
}
