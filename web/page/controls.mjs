// This file is part of OpenCV project.
// It is subject to the license terms in the LICENSE file found in the top-level directory
// of this distribution and at http://opencv.org/license.html.

// The parameters as controls, with the header's words from parameters.json

export const strategies = [
    { name: 'MST', text: 'minimum spanning tree', factory: 'createMinimumSpanningTree' },
    { name: 'ST', text: 'segment tree', factory: 'createSegmentTree' },
    { name: 'RT', text: 'random tree', factory: 'createRandomTree' },
];

// Those that are not here come last.
const groups = [
    ['Surfaces', ['P1', 'P2', 'scanlinePasses', 'gamma', 'blockSize']],
    ['Layers', ['numLayers', 'maxTopDisparities', 'finestLayer']],
    [
        'Filters',
        ['useSubpixel', 'fillOcclusions', 'disparityMedianSize', 'disp12MaxDiff', 'speckleWindowSize', 'speckleRange'],
    ],
    ['Cameras', ['maxRowOffset', 'useLightAlignment', 'noiseThreshold']],
    ['Algorithm', ['treeStrategy', 'matchingCost', 'aggregation', 'topAggregation', 'usePrediction', 'disparityPrior']],
];
const elsewhere = ['minDisparity', 'numDisparities', 'disparityDepth', 'useTemporalPrediction'];
const treeStrategy = {
    name: 'treeStrategy',
    kind: 'strategy',
    brief: 'Rule 1 and Rule 2 of the spanning trees.',
    text: 'Rule 1 and Rule 2 of the spanning trees.',
};

const element = (tag, properties = {}, ...children) => {
    const node = Object.assign(document.createElement(tag), properties);
    node.append(...children);
    return node;
};

export class Controls {
    // changed() is called when a setting is another one.
    constructor({ documentation, presets }, changed) {
        this.documentation = documentation;
        this.presets = presets;
        this.changed = changed;
        this.changes = {};
        this.fields = new Map();
        this.#addPresets(document.getElementById('presets'));
        document
            .getElementById('range-controls')
            .append(
                this.#rangeFinder(),
                this.#range('numDisparities', 'Disparities', 1, 512, 64),
                this.#range('minDisparity', 'Smallest disparity', -128, 128, 0),
            );
        this.#addGroups(document.getElementById('groups'));
        document.getElementById('reset').onclick = () => {
            this.changes = {};
            this.#showValues();
            this.changed();
        };
        this.#showValues();
    }

    get settings() {
        return {
            preset: this.preset,
            minDisparity: this.findsRange ? 0 : this.minDisparity,
            numDisparities: this.findsRange ? 0 : this.numDisparities,
            changes: { ...this.changes },
        };
    }

    // For images of another size, or as it was found
    suggestRange(numDisparities, minDisparity = 0) {
        this.numDisparities = numDisparities;
        this.minDisparity = minDisparity;
        for (const name of ['numDisparities', 'minDisparity']) this.fields.get(name).show(this[name]);
    }

    #addPresets(fieldset) {
        this.preset = 'FAST';
        const order = ['ULTRAFAST', 'FAST', 'QUALITY', 'TREE', 'PAPER'];
        for (const name of order) {
            const { text } = this.documentation.enumerations.Preset.find(p => p.name === `PRESET_${name}`);
            const input = element('input', {
                type: 'radio',
                name: 'preset',
                value: name,
                checked: name === this.preset,
            });
            input.onchange = () => {
                this.preset = name;
                this.changes = {};
                this.#showValues();
                this.changed();
            };
            fieldset.append(
                element(
                    'label',
                    { className: 'preset' },
                    input,
                    element('b', { textContent: name }),
                    element('small', { textContent: text.replaceAll('PRESET_', '') }),
                ),
            );
        }
    }

    // Whether the matcher finds the range; the last one found is where the visitor goes on by hand.
    #rangeFinder() {
        const input = element('input', { type: 'checkbox', role: 'switch', id: 'find-range' });
        this.#finder = input;
        input.onchange = () => {
            for (const name of ['numDisparities', 'minDisparity']) this.fields.get(name).disable(input.checked);
            this.changed();
        };
        return element(
            'div',
            { className: 'parameter' },
            element(
                'div',
                { className: 'line' },
                element('label', { htmlFor: input.id, textContent: 'Find the range' }),
                input,
            ),
            element('small', { textContent: 'It is then found in the pair, with a margin, which takes a bit longer.' }),
        );
    }

    get findsRange() {
        return this.#finder.checked;
    }

    #finder = null;

    #describe(name) {
        return this.documentation.parameters.find(p => p.name === name) ?? treeStrategy;
    }

    // A slider with a number beside it, which may be beyond its ends
    #range(name, title, min, max, value) {
        this[name] = value;
        const { brief } = this.#describe(name),
            id = `parameter-${name}`;
        const slider = element('input', { type: 'range', min, max, value, step: 1 });
        slider.setAttribute('aria-label', title);
        const number = element('input', { type: 'number', id, value, step: 1 });
        const set = input => {
            if (input.value === '') return;
            this[name] = Math.trunc(Number(input.value));
            (input === slider ? number : slider).value = this[name];
            this.changed();
        };
        slider.oninput = () => set(slider);
        number.onchange = () => set(number);
        this.fields.set(name, {
            show: shown => {
                slider.value = number.value = shown;
            },
            disable: isDisabled => {
                slider.disabled = number.disabled = isDisabled;
            },
        });
        return element(
            'div',
            { className: 'parameter' },
            element('div', { className: 'line' }, element('label', { htmlFor: id, textContent: title }), number),
            slider,
            element('small', { textContent: brief }),
        );
    }

    #addGroups(parent) {
        const named = new Set([...groups.flatMap(([, names]) => names), ...elsewhere]);
        const others = this.documentation.parameters.map(p => p.name).filter(name => !named.has(name));
        for (const [title, names] of [...groups, ['Of the paper', others]]) {
            const group = element('details', { className: 'group' }, element('summary', { textContent: title }));
            for (const name of names) group.append(this.#field(this.#describe(name)));
            parent.append(group);
        }
        parent.firstElementChild.open = matchMedia('(min-width: 901px)').matches;
    }

    #field(parameter) {
        const { name, kind, brief, text } = parameter,
            id = `parameter-${name}`;
        const { input, read, show } = this.#input(parameter, id);
        input.id = id;
        input.setAttribute('aria-describedby', `${id}-brief`);
        const node = element(
            'div',
            { className: `parameter ${kind}` },
            element('div', { className: 'line' }, element('label', { htmlFor: id, textContent: name }), input),
            text === brief
                ? element('small', { id: `${id}-brief`, textContent: brief })
                : element(
                      'details',
                      { className: 'more' },
                      element('summary', { id: `${id}-brief`, textContent: brief }),
                      element('small', { textContent: text.slice(text.startsWith(brief) ? brief.length : 0).trim() }),
                  ),
        );
        input.onchange = () => {
            const value = read();
            if (value === undefined) return;
            if (value === this.presets[this.preset][name]) delete this.changes[name];
            else this.changes[name] = value;
            node.classList.toggle('changed', name in this.changes);
            this.#showReset();
            this.changed();
        };
        this.fields.set(name, {
            show: value => {
                show(value);
                node.classList.toggle('changed', name in this.changes);
            },
        });
        return node;
    }

    #input({ name, kind, bounds }, id) {
        const choose = options => {
            const input = element('select');
            for (const { name: title, value } of options)
                input.append(element('option', { value, textContent: title }));
            return {
                input,
                show: value => {
                    input.value = value;
                },
            };
        };
        if (kind === 'strategy') {
            const select = choose(strategies.map(s => ({ name: `${s.name}, ${s.text}`, value: s.name })));
            return { ...select, read: () => select.input.value };
        }
        if (kind === 'bool') {
            const input = element('input', { type: 'checkbox', role: 'switch' });
            return {
                input,
                read: () => input.checked,
                show: value => {
                    input.checked = value;
                },
            };
        }
        const enumeration = Object.entries(this.documentation.enumerations).find(
            ([title]) => kind === 'int' && name.toLowerCase().endsWith(title.toLowerCase()),
        );
        if (enumeration) {
            const select = choose(enumeration[1]);
            return { ...select, read: () => Number(select.input.value) };
        }
        if (name === 'disparityMedianSize') {
            const select = choose(
                [
                    [-1, 'AUTO'],
                    [0, 'none'],
                    [3, '3'],
                    [5, '5'],
                    [7, '7'],
                ].map(([value, title]) => ({ name: title, value })),
            );
            return { ...select, read: () => Number(select.input.value) };
        }
        const input = element('input', { type: 'number', step: kind === 'int' ? 1 : 'any', inputMode: 'decimal' });
        if (bounds) [input.min, input.max] = bounds;
        const read = () =>
            input.value === '' ? undefined : kind === 'int' ? Math.trunc(Number(input.value)) : Number(input.value);
        return {
            input,
            read,
            show: value => {
                input.value = kind === 'int' ? value : Number(value.toPrecision(6));
            },
        };
    }

    #showValues() {
        const values = { ...this.presets[this.preset], ...this.changes };
        for (const [name, { show }] of this.fields)
            if (name !== 'numDisparities' && name !== 'minDisparity') show(values[name]);
        this.#showReset();
    }

    #showReset() {
        document.getElementById('reset').disabled = Object.keys(this.changes).length === 0;
    }
}
