--
-- PostgreSQL database dump
--

\restrict 8C1d06yn7Ib8Ebv04hcpRdChFhs4esXBb6htacjDqkYzuyehjDLreGe4EVMsMzQ

-- Dumped from database version 15.20 (Debian 15.20-0+deb12u1)
-- Dumped by pg_dump version 15.20 (Debian 15.20-0+deb12u1)

SET statement_timeout = 0;
SET lock_timeout = 0;
SET idle_in_transaction_session_timeout = 0;
SET client_encoding = 'UTF8';
SET standard_conforming_strings = on;
SELECT pg_catalog.set_config('search_path', '', false);
SET check_function_bodies = false;
SET xmloption = content;
SET client_min_messages = warning;
SET row_security = off;

--
-- Name: frozen_0_1_0; Type: SCHEMA; Schema: -; Owner: -
--

CREATE SCHEMA frozen_0_1_0;


SET default_tablespace = '';

SET default_table_access_method = heap;

--
-- Name: adapted; Type: TABLE; Schema: frozen_0_1_0; Owner: -
--

CREATE TABLE frozen_0_1_0.adapted (
    cage text NOT NULL,
    factors text NOT NULL
);


--
-- Name: aggregate; Type: TABLE; Schema: frozen_0_1_0; Owner: -
--

CREATE TABLE frozen_0_1_0.aggregate (
    cage text NOT NULL,
    stream text NOT NULL,
    quantity text NOT NULL,
    width bigint NOT NULL,
    t bigint NOT NULL,
    n bigint NOT NULL,
    mean double precision NOT NULL,
    "least" double precision NOT NULL,
    most double precision NOT NULL
);


--
-- Name: alarm_book; Type: TABLE; Schema: frozen_0_1_0; Owner: -
--

CREATE TABLE frozen_0_1_0.alarm_book (
    cage text NOT NULL,
    book text NOT NULL
);


--
-- Name: journal; Type: TABLE; Schema: frozen_0_1_0; Owner: -
--

CREATE TABLE frozen_0_1_0.journal (
    number bigint NOT NULL,
    cage text NOT NULL,
    t bigint NOT NULL,
    line text NOT NULL
);


--
-- Name: journal_number_seq; Type: SEQUENCE; Schema: frozen_0_1_0; Owner: -
--

ALTER TABLE frozen_0_1_0.journal ALTER COLUMN number ADD GENERATED ALWAYS AS IDENTITY (
    SEQUENCE NAME frozen_0_1_0.journal_number_seq
    START WITH 1
    INCREMENT BY 1
    NO MINVALUE
    NO MAXVALUE
    CACHE 1
);


--
-- Name: mark; Type: TABLE; Schema: frozen_0_1_0; Owner: -
--

CREATE TABLE frozen_0_1_0.mark (
    cage text NOT NULL,
    stream text NOT NULL,
    t bigint NOT NULL,
    touched bigint NOT NULL
);


--
-- Name: sample; Type: TABLE; Schema: frozen_0_1_0; Owner: -
--

CREATE TABLE frozen_0_1_0.sample (
    cage text NOT NULL,
    stream text NOT NULL,
    t bigint NOT NULL,
    seq bigint NOT NULL,
    readings text NOT NULL,
    remarks text NOT NULL,
    t_ingest bigint NOT NULL
)
PARTITION BY RANGE (t);


--
-- Name: sample_2020_01; Type: TABLE; Schema: frozen_0_1_0; Owner: -
--

CREATE TABLE frozen_0_1_0.sample_2020_01 (
    cage text NOT NULL,
    stream text NOT NULL,
    t bigint NOT NULL,
    seq bigint NOT NULL,
    readings text NOT NULL,
    remarks text NOT NULL,
    t_ingest bigint NOT NULL
);


--
-- Name: sealed; Type: TABLE; Schema: frozen_0_1_0; Owner: -
--

CREATE TABLE frozen_0_1_0.sealed (
    cage text NOT NULL,
    stream text NOT NULL,
    t bigint NOT NULL
);


--
-- Name: trial; Type: TABLE; Schema: frozen_0_1_0; Owner: -
--

CREATE TABLE frozen_0_1_0.trial (
    id bigint NOT NULL,
    t bigint NOT NULL
);


--
-- Name: sample_2020_01; Type: TABLE ATTACH; Schema: frozen_0_1_0; Owner: -
--

ALTER TABLE ONLY frozen_0_1_0.sample ATTACH PARTITION frozen_0_1_0.sample_2020_01 FOR VALUES FROM ('1577836800000000') TO ('1580515200000000');


--
-- Data for Name: adapted; Type: TABLE DATA; Schema: frozen_0_1_0; Owner: -
--

COPY frozen_0_1_0.adapted (cage, factors) FROM stdin;
ace	{"depth-1": {"factor": 0.9910403787728839, "judged": "2020-01-19T23:50:00+00:00"}, "depth-2": {"factor": 0.9910403787728839, "judged": "2020-01-19T23:50:00+00:00"}, "depth-3": {"factor": 1.0010005001667088, "judged": "2020-01-19T23:50:00+00:00"}, "shackle-1": {"factor": 1.0010005001667088, "judged": "2020-01-19T23:50:00+00:00"}, "shackle-2": {"factor": 0.9910403787728839, "judged": "2020-01-19T23:50:00+00:00"}, "shackle-3": {"factor": 0.9910403787728839, "judged": "2020-01-19T23:50:00+00:00"}, "shackle-4": {"factor": 0.9910403787728839, "judged": "2020-01-19T23:50:00+00:00"}, "shackle-5": {"factor": 1.0110607224447197, "judged": "2020-01-19T23:50:00+00:00"}}
\.


--
-- Data for Name: aggregate; Type: TABLE DATA; Schema: frozen_0_1_0; Owner: -
--

COPY frozen_0_1_0.aggregate (cage, stream, quantity, width, t, n, mean, "least", most) FROM stdin;
\.


--
-- Data for Name: alarm_book; Type: TABLE DATA; Schema: frozen_0_1_0; Owner: -
--

COPY frozen_0_1_0.alarm_book (cage, book) FROM stdin;
ace	{"alarms":{"load.bridle-1":{"name":"load.bridle-1","active":false,"acknowledged":true,"since":null,"crossed":null,"said":null,"value":0.017999015709978118,"worst":null,"shelved_until":null,"shelved_once":false,"in_service":true,"comment":"","detail":""},"load.bridle-2":{"name":"load.bridle-2","active":false,"acknowledged":true,"since":null,"crossed":null,"said":null,"value":0.03928823731833678,"worst":null,"shelved_until":null,"shelved_once":false,"in_service":true,"comment":"","detail":""},"load.bridle-3":{"name":"load.bridle-3","active":false,"acknowledged":true,"since":null,"crossed":null,"said":null,"value":0.032356544083321094,"worst":null,"shelved_until":null,"shelved_once":false,"in_service":true,"comment":"","detail":""},"load.bridle-4":{"name":"load.bridle-4","active":false,"acknowledged":true,"since":null,"crossed":null,"said":null,"value":0.032356544083321094,"worst":null,"shelved_until":null,"shelved_once":false,"in_service":true,"comment":"","detail":""},"load.bridle-5":{"name":"load.bridle-5","active":false,"acknowledged":true,"since":null,"crossed":null,"said":null,"value":0.050565871035496944,"worst":null,"shelved_until":null,"shelved_once":false,"in_service":true,"comment":"","detail":""},"load.bridle-6":{"name":"load.bridle-6","active":false,"acknowledged":true,"since":null,"crossed":null,"said":null,"value":0.051962468485530905,"worst":null,"shelved_until":null,"shelved_once":false,"in_service":true,"comment":"","detail":""},"load.bridle-7":{"name":"load.bridle-7","active":false,"acknowledged":true,"since":null,"crossed":null,"said":null,"value":0.07201943831469061,"worst":null,"shelved_until":null,"shelved_once":false,"in_service":true,"comment":"","detail":""},"load.bridle-8":{"name":"load.bridle-8","active":false,"acknowledged":true,"since":null,"crossed":null,"said":null,"value":0.03170148411053848,"worst":null,"shelved_until":null,"shelved_once":false,"in_service":true,"comment":"","detail":""},"load.bridle-9":{"name":"load.bridle-9","active":false,"acknowledged":true,"since":null,"crossed":null,"said":null,"value":0.04229647828869035,"worst":null,"shelved_until":null,"shelved_once":false,"in_service":true,"comment":"","detail":""},"load.bridle-10":{"name":"load.bridle-10","active":false,"acknowledged":true,"since":null,"crossed":null,"said":null,"value":0.042630524995559756,"worst":null,"shelved_until":null,"shelved_once":false,"in_service":true,"comment":"","detail":""},"load.bridle-11":{"name":"load.bridle-11","active":false,"acknowledged":true,"since":null,"crossed":null,"said":null,"value":0.018055533659789638,"worst":null,"shelved_until":null,"shelved_once":false,"in_service":true,"comment":"","detail":""},"load.bridle-12":{"name":"load.bridle-12","active":false,"acknowledged":true,"since":null,"crossed":null,"said":null,"value":0.017999015709978118,"worst":null,"shelved_until":null,"shelved_once":false,"in_service":true,"comment":"","detail":""},"volume.net":{"name":"volume.net","active":false,"acknowledged":true,"since":null,"crossed":null,"said":null,"value":0.021362807501023373,"worst":null,"shelved_until":null,"shelved_once":false,"in_service":true,"comment":"","detail":""},"silent.buoy-1":{"name":"silent.buoy-1","active":false,"acknowledged":true,"since":null,"crossed":null,"said":null,"value":720.0,"worst":null,"shelved_until":null,"shelved_once":false,"in_service":true,"comment":"","detail":""},"silent.depth-1":{"name":"silent.depth-1","active":false,"acknowledged":true,"since":null,"crossed":null,"said":null,"value":600.0,"worst":null,"shelved_until":null,"shelved_once":false,"in_service":true,"comment":"","detail":""},"silent.depth-2":{"name":"silent.depth-2","active":false,"acknowledged":true,"since":null,"crossed":null,"said":null,"value":600.0,"worst":null,"shelved_until":null,"shelved_once":false,"in_service":true,"comment":"","detail":""},"silent.depth-3":{"name":"silent.depth-3","active":false,"acknowledged":true,"since":null,"crossed":null,"said":null,"value":600.0,"worst":null,"shelved_until":null,"shelved_once":false,"in_service":true,"comment":"","detail":""},"silent.shackle-1":{"name":"silent.shackle-1","active":false,"acknowledged":true,"since":null,"crossed":null,"said":null,"value":600.0,"worst":null,"shelved_until":null,"shelved_once":false,"in_service":true,"comment":"","detail":""},"silent.shackle-2":{"name":"silent.shackle-2","active":false,"acknowledged":true,"since":null,"crossed":null,"said":null,"value":600.0,"worst":null,"shelved_until":null,"shelved_once":false,"in_service":true,"comment":"","detail":""},"silent.shackle-3":{"name":"silent.shackle-3","active":false,"acknowledged":true,"since":null,"crossed":null,"said":null,"value":600.0,"worst":null,"shelved_until":null,"shelved_once":false,"in_service":true,"comment":"","detail":""},"silent.shackle-4":{"name":"silent.shackle-4","active":false,"acknowledged":true,"since":null,"crossed":null,"said":null,"value":600.0,"worst":null,"shelved_until":null,"shelved_once":false,"in_service":true,"comment":"","detail":""},"silent.shackle-5":{"name":"silent.shackle-5","active":false,"acknowledged":true,"since":null,"crossed":null,"said":null,"value":600.0,"worst":null,"shelved_until":null,"shelved_once":false,"in_service":true,"comment":"","detail":""},"input.buoy-1":{"name":"input.buoy-1","active":false,"acknowledged":true,"since":null,"crossed":null,"said":null,"value":0.0,"worst":null,"shelved_until":null,"shelved_once":false,"in_service":true,"comment":"","detail":""},"domain.input":{"name":"domain.input","active":false,"acknowledged":true,"since":null,"crossed":null,"said":null,"value":0.0,"worst":null,"shelved_until":null,"shelved_once":false,"in_service":true,"comment":"","detail":""},"bridle.bridle-1":{"name":"bridle.bridle-1","active":false,"acknowledged":true,"since":null,"crossed":null,"said":null,"value":0.0,"worst":null,"shelved_until":null,"shelved_once":false,"in_service":true,"comment":"","detail":""},"bridle.bridle-2":{"name":"bridle.bridle-2","active":false,"acknowledged":true,"since":null,"crossed":null,"said":null,"value":0.0,"worst":null,"shelved_until":null,"shelved_once":false,"in_service":true,"comment":"","detail":""},"bridle.bridle-3":{"name":"bridle.bridle-3","active":false,"acknowledged":true,"since":null,"crossed":null,"said":null,"value":0.0,"worst":null,"shelved_until":null,"shelved_once":false,"in_service":true,"comment":"","detail":""},"bridle.bridle-4":{"name":"bridle.bridle-4","active":false,"acknowledged":true,"since":null,"crossed":null,"said":null,"value":0.0,"worst":null,"shelved_until":null,"shelved_once":false,"in_service":true,"comment":"","detail":""},"bridle.bridle-5":{"name":"bridle.bridle-5","active":false,"acknowledged":true,"since":null,"crossed":null,"said":null,"value":0.0,"worst":null,"shelved_until":null,"shelved_once":false,"in_service":true,"comment":"","detail":""},"bridle.bridle-6":{"name":"bridle.bridle-6","active":false,"acknowledged":true,"since":null,"crossed":null,"said":null,"value":0.0,"worst":null,"shelved_until":null,"shelved_once":false,"in_service":true,"comment":"","detail":""},"bridle.bridle-7":{"name":"bridle.bridle-7","active":false,"acknowledged":true,"since":null,"crossed":null,"said":null,"value":0.0,"worst":null,"shelved_until":null,"shelved_once":false,"in_service":true,"comment":"","detail":""},"bridle.bridle-8":{"name":"bridle.bridle-8","active":false,"acknowledged":true,"since":null,"crossed":null,"said":null,"value":0.0,"worst":null,"shelved_until":null,"shelved_once":false,"in_service":true,"comment":"","detail":""},"bridle.bridle-9":{"name":"bridle.bridle-9","active":false,"acknowledged":true,"since":null,"crossed":null,"said":null,"value":0.0,"worst":null,"shelved_until":null,"shelved_once":false,"in_service":true,"comment":"","detail":""},"bridle.bridle-10":{"name":"bridle.bridle-10","active":false,"acknowledged":true,"since":null,"crossed":null,"said":null,"value":0.0,"worst":null,"shelved_until":null,"shelved_once":false,"in_service":true,"comment":"","detail":""},"bridle.bridle-11":{"name":"bridle.bridle-11","active":false,"acknowledged":true,"since":null,"crossed":null,"said":null,"value":0.0,"worst":null,"shelved_until":null,"shelved_once":false,"in_service":true,"comment":"","detail":""},"bridle.bridle-12":{"name":"bridle.bridle-12","active":false,"acknowledged":true,"since":null,"crossed":null,"said":null,"value":0.0,"worst":null,"shelved_until":null,"shelved_once":false,"in_service":true,"comment":"","detail":""},"net.net":{"name":"net.net","active":false,"acknowledged":true,"since":null,"crossed":null,"said":null,"value":0.0,"worst":null,"shelved_until":null,"shelved_once":false,"in_service":true,"comment":"","detail":""},"irregular.buoy-1":{"name":"irregular.buoy-1","active":false,"acknowledged":true,"since":null,"crossed":null,"said":null,"value":0.0,"worst":null,"shelved_until":null,"shelved_once":false,"in_service":true,"comment":"","detail":""},"irregular.depth-1":{"name":"irregular.depth-1","active":false,"acknowledged":true,"since":null,"crossed":null,"said":null,"value":0.0,"worst":null,"shelved_until":null,"shelved_once":false,"in_service":true,"comment":"","detail":""},"irregular.depth-2":{"name":"irregular.depth-2","active":false,"acknowledged":true,"since":null,"crossed":null,"said":null,"value":0.0,"worst":null,"shelved_until":null,"shelved_once":false,"in_service":true,"comment":"","detail":""},"irregular.depth-3":{"name":"irregular.depth-3","active":false,"acknowledged":true,"since":null,"crossed":null,"said":null,"value":0.0,"worst":null,"shelved_until":null,"shelved_once":false,"in_service":true,"comment":"","detail":""},"irregular.shackle-1":{"name":"irregular.shackle-1","active":false,"acknowledged":true,"since":null,"crossed":null,"said":null,"value":0.0,"worst":null,"shelved_until":null,"shelved_once":false,"in_service":true,"comment":"","detail":""},"irregular.shackle-2":{"name":"irregular.shackle-2","active":false,"acknowledged":true,"since":null,"crossed":null,"said":null,"value":0.0,"worst":null,"shelved_until":null,"shelved_once":false,"in_service":true,"comment":"","detail":""},"irregular.shackle-3":{"name":"irregular.shackle-3","active":false,"acknowledged":true,"since":null,"crossed":null,"said":null,"value":0.0,"worst":null,"shelved_until":null,"shelved_once":false,"in_service":true,"comment":"","detail":""},"irregular.shackle-4":{"name":"irregular.shackle-4","active":false,"acknowledged":true,"since":null,"crossed":null,"said":null,"value":0.0,"worst":null,"shelved_until":null,"shelved_once":false,"in_service":true,"comment":"","detail":""},"irregular.shackle-5":{"name":"irregular.shackle-5","active":false,"acknowledged":true,"since":null,"crossed":null,"said":null,"value":0.0,"worst":null,"shelved_until":null,"shelved_once":false,"in_service":true,"comment":"","detail":""}},"t":"2020-01-20T00:00:00Z","suspicion":{"senses":{"buoy-1":{"heard":"2020-01-19T23:48:00Z","values":[0.3073707760563661,156.03256553062198,0.8167494075077953,5.0,250.0],"since":"2020-01-19T23:48:00Z","repeats":0,"count":0,"error":0.0},"depth-1":{"heard":"2020-01-19T23:50:00Z","values":[6.820118030290886],"since":"2020-01-19T23:50:00Z","repeats":0,"count":1,"error":-0.002588103935017294},"depth-2":{"heard":"2020-01-19T23:50:00Z","values":[14.581475571941588],"since":"2020-01-19T23:50:00Z","repeats":0,"count":1,"error":-0.02776455698950997},"depth-3":{"heard":"2020-01-19T23:50:00Z","values":[30.08357384392988],"since":"2020-01-19T23:50:00Z","repeats":0,"count":1,"error":-0.044839168263415274},"shackle-1":{"heard":"2020-01-19T23:50:00Z","values":[11.437721144025621],"since":"2020-01-19T23:50:00Z","repeats":0,"count":1,"error":-85.3889863248769},"shackle-2":{"heard":"2020-01-19T23:50:00Z","values":[5.026161092630065],"since":"2020-01-19T23:50:00Z","repeats":0,"count":1,"error":-46.07636505609298},"shackle-3":{"heard":"2020-01-19T23:50:00Z","values":[6.623992851518774],"since":"2020-01-19T23:50:00Z","repeats":0,"count":1,"error":-143.44367467168195},"shackle-4":{"heard":"2020-01-19T23:50:00Z","values":[6.399692679669094],"since":"2020-01-19T23:50:00Z","repeats":0,"count":1,"error":-421.19131962046686},"shackle-5":{"heard":"2020-01-19T23:50:00Z","values":[2.886016724608934],"since":"2020-01-19T23:50:00Z","repeats":0,"count":1,"error":-2.868660957407883}},"opened":{"number":877488,"ticks":1,"east":0.12485933914700124,"north":-0.28086818866020924},"usual":{"sensors":[],"size":[],"covariance":[],"restless":[]},"beliefs":{},"told":[],"waited":0},"format":"seacage alarms 1"}
\.


--
-- Data for Name: journal; Type: TABLE DATA; Schema: frozen_0_1_0; Owner: -
--

COPY frozen_0_1_0.journal (number, cage, t, line) FROM stdin;
\.


--
-- Data for Name: mark; Type: TABLE DATA; Schema: frozen_0_1_0; Owner: -
--

COPY frozen_0_1_0.mark (cage, stream, t, touched) FROM stdin;
ace	buoy-1	1579467600000000	1795360378792046
ace	buoy-1	1579468200000000	1795360378792046
ace	buoy-1	1579468800000000	1795360378792046
ace	buoy-1	1579469400000000	1795360378792046
ace	buoy-1	1579470000000000	1795360378792046
ace	buoy-1	1579471200000000	1795360378792046
ace	buoy-1	1579471800000000	1795360378792046
ace	buoy-1	1579472400000000	1795360378792046
ace	buoy-1	1579473000000000	1795360378792046
ace	buoy-1	1579473600000000	1795360378792046
ace	buoy-1	1579474800000000	1795360378792046
ace	buoy-1	1579475400000000	1795360378792046
ace	buoy-1	1579476000000000	1795360378792046
ace	buoy-1	1579476600000000	1795360378792046
ace	buoy-1	1579477200000000	1795360378792046
ace	depth-1	1579467600000000	1795360378792046
ace	depth-1	1579468200000000	1795360378792046
ace	depth-1	1579468800000000	1795360378792046
ace	depth-1	1579469400000000	1795360378792046
ace	depth-1	1579470000000000	1795360378792046
ace	depth-1	1579470600000000	1795360378792046
ace	depth-1	1579471200000000	1795360378792046
ace	depth-1	1579471800000000	1795360378792046
ace	depth-1	1579472400000000	1795360378792046
ace	depth-1	1579473000000000	1795360378792046
ace	depth-1	1579473600000000	1795360378792046
ace	depth-1	1579474200000000	1795360378792046
ace	depth-1	1579474800000000	1795360378792046
ace	depth-1	1579475400000000	1795360378792046
ace	depth-1	1579476000000000	1795360378792046
ace	depth-1	1579476600000000	1795360378792046
ace	depth-1	1579477200000000	1795360378792046
ace	depth-1	1579477800000000	1795360378792046
ace	depth-2	1579467600000000	1795360378792046
ace	depth-2	1579468200000000	1795360378792046
ace	depth-2	1579468800000000	1795360378792046
ace	depth-2	1579469400000000	1795360378792046
ace	depth-2	1579470000000000	1795360378792046
ace	depth-2	1579470600000000	1795360378792046
ace	depth-2	1579471200000000	1795360378792046
ace	depth-2	1579471800000000	1795360378792046
ace	depth-2	1579472400000000	1795360378792046
ace	depth-2	1579473000000000	1795360378792046
ace	depth-2	1579473600000000	1795360378792046
ace	depth-2	1579474200000000	1795360378792046
ace	depth-2	1579474800000000	1795360378792046
ace	depth-2	1579475400000000	1795360378792046
ace	depth-2	1579476000000000	1795360378792046
ace	depth-2	1579476600000000	1795360378792046
ace	depth-2	1579477200000000	1795360378792046
ace	depth-2	1579477800000000	1795360378792046
ace	depth-3	1579467600000000	1795360378792046
ace	depth-3	1579468200000000	1795360378792046
ace	depth-3	1579468800000000	1795360378792046
ace	depth-3	1579469400000000	1795360378792046
ace	depth-3	1579470000000000	1795360378792046
ace	depth-3	1579470600000000	1795360378792046
ace	depth-3	1579471200000000	1795360378792046
ace	depth-3	1579471800000000	1795360378792046
ace	depth-3	1579472400000000	1795360378792046
ace	depth-3	1579473000000000	1795360378792046
ace	depth-3	1579473600000000	1795360378792046
ace	depth-3	1579474200000000	1795360378792046
ace	depth-3	1579474800000000	1795360378792046
ace	depth-3	1579475400000000	1795360378792046
ace	depth-3	1579476000000000	1795360378792046
ace	depth-3	1579476600000000	1795360378792046
ace	depth-3	1579477200000000	1795360378792046
ace	depth-3	1579477800000000	1795360378792046
ace	shackle-1	1579467600000000	1795360378792046
ace	shackle-1	1579468200000000	1795360378792046
ace	shackle-1	1579468800000000	1795360378792046
ace	shackle-1	1579469400000000	1795360378792046
ace	shackle-1	1579470000000000	1795360378792046
ace	shackle-1	1579470600000000	1795360378792046
ace	shackle-1	1579471200000000	1795360378792046
ace	shackle-1	1579471800000000	1795360378792046
ace	shackle-1	1579472400000000	1795360378792046
ace	shackle-1	1579473000000000	1795360378792046
ace	shackle-1	1579473600000000	1795360378792046
ace	shackle-1	1579474200000000	1795360378792046
ace	shackle-1	1579474800000000	1795360378792046
ace	shackle-1	1579475400000000	1795360378792046
ace	shackle-1	1579476000000000	1795360378792046
ace	shackle-1	1579476600000000	1795360378792046
ace	shackle-1	1579477200000000	1795360378792046
ace	shackle-1	1579477800000000	1795360378792046
ace	shackle-2	1579467600000000	1795360378792046
ace	shackle-2	1579468200000000	1795360378792046
ace	shackle-2	1579468800000000	1795360378792046
ace	shackle-2	1579469400000000	1795360378792046
ace	shackle-2	1579470000000000	1795360378792046
ace	shackle-2	1579470600000000	1795360378792046
ace	shackle-2	1579471200000000	1795360378792046
ace	shackle-2	1579471800000000	1795360378792046
ace	shackle-2	1579472400000000	1795360378792046
ace	shackle-2	1579473000000000	1795360378792046
ace	shackle-2	1579473600000000	1795360378792046
ace	shackle-2	1579474200000000	1795360378792046
ace	shackle-2	1579474800000000	1795360378792046
ace	shackle-2	1579475400000000	1795360378792046
ace	shackle-2	1579476000000000	1795360378792046
ace	shackle-2	1579476600000000	1795360378792046
ace	shackle-2	1579477200000000	1795360378792046
ace	shackle-2	1579477800000000	1795360378792046
ace	shackle-3	1579467600000000	1795360378792046
ace	shackle-3	1579468200000000	1795360378792046
ace	shackle-3	1579468800000000	1795360378792046
ace	shackle-3	1579469400000000	1795360378792046
ace	shackle-3	1579470000000000	1795360378792046
ace	shackle-3	1579470600000000	1795360378792046
ace	shackle-3	1579471200000000	1795360378792046
ace	shackle-3	1579471800000000	1795360378792046
ace	shackle-3	1579472400000000	1795360378792046
ace	shackle-3	1579473000000000	1795360378792046
ace	shackle-3	1579473600000000	1795360378792046
ace	shackle-3	1579474200000000	1795360378792046
ace	shackle-3	1579474800000000	1795360378792046
ace	shackle-3	1579475400000000	1795360378792046
ace	shackle-3	1579476000000000	1795360378792046
ace	shackle-3	1579476600000000	1795360378792046
ace	shackle-3	1579477200000000	1795360378792046
ace	shackle-3	1579477800000000	1795360378792046
ace	shackle-4	1579467600000000	1795360378792046
ace	shackle-4	1579468200000000	1795360378792046
ace	shackle-4	1579468800000000	1795360378792046
ace	shackle-4	1579469400000000	1795360378792046
ace	shackle-4	1579470000000000	1795360378792046
ace	shackle-4	1579470600000000	1795360378792046
ace	shackle-4	1579471200000000	1795360378792046
ace	shackle-4	1579471800000000	1795360378792046
ace	shackle-4	1579472400000000	1795360378792046
ace	shackle-4	1579473000000000	1795360378792046
ace	shackle-4	1579473600000000	1795360378792046
ace	shackle-4	1579474200000000	1795360378792046
ace	shackle-4	1579474800000000	1795360378792046
ace	shackle-4	1579475400000000	1795360378792046
ace	shackle-4	1579476000000000	1795360378792046
ace	shackle-4	1579476600000000	1795360378792046
ace	shackle-4	1579477200000000	1795360378792046
ace	shackle-4	1579477800000000	1795360378792046
ace	shackle-5	1579467600000000	1795360378792046
ace	shackle-5	1579468200000000	1795360378792046
ace	shackle-5	1579468800000000	1795360378792046
ace	shackle-5	1579469400000000	1795360378792046
ace	shackle-5	1579470000000000	1795360378792046
ace	shackle-5	1579470600000000	1795360378792046
ace	shackle-5	1579471200000000	1795360378792046
ace	shackle-5	1579471800000000	1795360378792046
ace	shackle-5	1579472400000000	1795360378792046
ace	shackle-5	1579473000000000	1795360378792046
ace	shackle-5	1579473600000000	1795360378792046
ace	shackle-5	1579474200000000	1795360378792046
ace	shackle-5	1579474800000000	1795360378792046
ace	shackle-5	1579475400000000	1795360378792046
ace	shackle-5	1579476000000000	1795360378792046
ace	shackle-5	1579476600000000	1795360378792046
ace	shackle-5	1579477200000000	1795360378792046
ace	shackle-5	1579477800000000	1795360378792046
\.


--
-- Data for Name: sample_2020_01; Type: TABLE DATA; Schema: frozen_0_1_0; Owner: -
--

COPY frozen_0_1_0.sample_2020_01 (cage, stream, t, seq, readings, remarks, t_ingest) FROM stdin;
ace	buoy-1	1579467600000000	1	{"current_speed_m_s": [0.5167462043157819, 1], "current_to_deg": [238.39561444286946, 1], "hs_m": [0.8, 1], "tp_s": [5.0, 1], "wave_from_deg": [250.0, 1]}	[]	1579478400000000
ace	buoy-1	1579468320000000	2	{"current_speed_m_s": [0.5005280198907788, 1], "current_to_deg": [234.61965154076307, 1], "hs_m": [0.8099334665397531, 1], "tp_s": [5.0, 1], "wave_from_deg": [250.0, 1]}	[]	1579478400000000
ace	buoy-1	1579469040000000	3	{"current_speed_m_s": [0.4828126785497809, 1], "current_to_deg": [230.6049657019267, 1], "hs_m": [0.8194709171154326, 1], "tp_s": [5.0, 1], "wave_from_deg": [250.0, 1]}	[]	1579478400000000
ace	buoy-1	1579469760000000	4	{"current_speed_m_s": [0.46398622541750767, 1], "current_to_deg": [226.3156989322018, 1], "hs_m": [0.8282321236697519, 1], "tp_s": [5.0, 1], "wave_from_deg": [250.0, 1]}	[]	1579478400000000
ace	buoy-1	1579470480000000	5	{"current_speed_m_s": [0.4444695647102165, 1], "current_to_deg": [221.71488498868044, 1], "hs_m": [0.8358678045449762, 1], "tp_s": [5.0, 1], "wave_from_deg": [250.0, 1]}	[]	1579478400000000
ace	buoy-1	1579471200000000	6	{"current_speed_m_s": [0.4247139677819342, 1], "current_to_deg": [216.76611906632485, 1], "hs_m": [0.8420735492403949, 1], "tp_s": [5.0, 1], "wave_from_deg": [250.0, 1]}	[]	1579478400000000
ace	buoy-1	1579471920000000	7	{"current_speed_m_s": [0.4051937627068173, 1], "current_to_deg": [211.43633934748976, 1], "hs_m": [0.8466019542983614, 1], "tp_s": [5.0, 1], "wave_from_deg": [250.0, 1]}	[]	1579478400000000
ace	buoy-1	1579472640000000	8	{"current_speed_m_s": [0.386394783525737, 1], "current_to_deg": [205.69997147581418, 1], "hs_m": [0.849272486499423, 1], "tp_s": [5.0, 1], "wave_from_deg": [250.0, 1]}	[]	1579478400000000
ace	buoy-1	1579473360000000	9	{"current_speed_m_s": [0.3687969821101909, 1], "current_to_deg": [199.54445885596687, 1], "hs_m": [0.8499786801520753, 1], "tp_s": [5.0, 1], "wave_from_deg": [250.0, 1]}	[]	1579478400000000
ace	buoy-1	1579474080000000	10	{"current_speed_m_s": [0.3528499458077492, 1], "current_to_deg": [192.97669454548964, 1], "hs_m": [0.8486923815439098, 1], "tp_s": [5.0, 1], "wave_from_deg": [250.0, 1]}	[]	1579478400000000
ace	buoy-1	1579474800000000	11	{"current_speed_m_s": [0.33894136329005103, 1], "current_to_deg": [186.0290754272083, 1], "hs_m": [0.8454648713412841, 1], "tp_s": [5.0, 1], "wave_from_deg": [250.0, 1]}	[]	1579478400000000
ace	buoy-1	1579475520000000	12	{"current_speed_m_s": [0.3273610134241652, 1], "current_to_deg": [178.76305869082628, 1], "hs_m": [0.8404248201909795, 1], "tp_s": [5.0, 1], "wave_from_deg": [250.0, 1]}	[]	1579478400000000
ace	buoy-1	1579476240000000	13	{"current_speed_m_s": [0.31826619700040854, 1], "current_to_deg": [171.26780297002134, 1], "hs_m": [0.8337731590275576, 1], "tp_s": [5.0, 1], "wave_from_deg": [250.0, 1]}	[]	1579478400000000
ace	buoy-1	1579476960000000	14	{"current_speed_m_s": [0.31165715785916315, 1], "current_to_deg": [163.65241161184684, 1], "hs_m": [0.8257750685910733, 1], "tp_s": [5.0, 1], "wave_from_deg": [250.0, 1]}	[]	1579478400000000
ace	buoy-1	1579477680000000	15	{"current_speed_m_s": [0.3073707760563661, 1], "current_to_deg": [156.03256553062198, 1], "hs_m": [0.8167494075077953, 1], "tp_s": [5.0, 1], "wave_from_deg": [250.0, 1]}	[]	1579478400000000
ace	depth-1	1579467600000000	1	{"depth_m": [6.454159067184941, 1]}	[]	1579478400000000
ace	depth-1	1579468200000000	2	{"depth_m": [6.510936814839955, 1]}	[]	1579478400000000
ace	depth-1	1579468800000000	3	{"depth_m": [6.540701792372196, 1]}	[]	1579478400000000
ace	depth-1	1579469400000000	4	{"depth_m": [6.599149455758515, 1]}	[]	1579478400000000
ace	depth-1	1579470000000000	5	{"depth_m": [6.574617389166609, 1]}	[]	1579478400000000
ace	depth-1	1579470600000000	6	{"depth_m": [6.649824355654245, 1]}	[]	1579478400000000
ace	depth-1	1579471200000000	7	{"depth_m": [6.706779446569535, 1]}	[]	1579478400000000
ace	depth-1	1579471800000000	8	{"depth_m": [6.659999493226376, 1]}	[]	1579478400000000
ace	depth-1	1579472400000000	9	{"depth_m": [6.738890662997541, 1]}	[]	1579478400000000
ace	depth-1	1579473000000000	10	{"depth_m": [6.704751336521954, 1]}	[]	1579478400000000
ace	depth-1	1579473600000000	11	{"depth_m": [6.763531913213024, 1]}	[]	1579478400000000
ace	depth-1	1579474200000000	12	{"depth_m": [6.78109465853343, 1]}	[]	1579478400000000
ace	depth-1	1579474800000000	13	{"depth_m": [6.836772455815531, 1]}	[]	1579478400000000
ace	depth-1	1579475400000000	14	{"depth_m": [6.775797212357457, 1]}	[]	1579478400000000
ace	depth-1	1579476000000000	15	{"depth_m": [6.810920116256278, 1]}	[]	1579478400000000
ace	depth-1	1579476600000000	16	{"depth_m": [6.844143342515942, 1]}	[]	1579478400000000
ace	depth-1	1579477200000000	17	{"depth_m": [6.78243441421463, 1]}	[]	1579478400000000
ace	depth-1	1579477800000000	18	{"depth_m": [6.820118030290886, 1]}	[]	1579478400000000
ace	depth-2	1579467600000000	1	{"depth_m": [13.892325846272053, 1]}	[]	1579478400000000
ace	depth-2	1579468200000000	2	{"depth_m": [13.963909427522271, 1]}	[]	1579478400000000
ace	depth-2	1579468800000000	3	{"depth_m": [13.985375356511618, 1]}	[]	1579478400000000
ace	depth-2	1579469400000000	4	{"depth_m": [14.069281389977458, 1]}	[]	1579478400000000
ace	depth-2	1579470000000000	5	{"depth_m": [14.153127193464895, 1]}	[]	1579478400000000
ace	depth-2	1579470600000000	6	{"depth_m": [14.235036086400061, 1]}	[]	1579478400000000
ace	depth-2	1579471200000000	7	{"depth_m": [14.299770804268201, 1]}	[]	1579478400000000
ace	depth-2	1579471800000000	8	{"depth_m": [14.32370049499095, 1]}	[]	1579478400000000
ace	depth-2	1579472400000000	9	{"depth_m": [14.348761607227553, 1]}	[]	1579478400000000
ace	depth-2	1579473000000000	10	{"depth_m": [14.377006706411608, 1]}	[]	1579478400000000
ace	depth-2	1579473600000000	11	{"depth_m": [14.491234523001165, 1]}	[]	1579478400000000
ace	depth-2	1579474200000000	12	{"depth_m": [14.54625969752924, 1]}	[]	1579478400000000
ace	depth-2	1579474800000000	13	{"depth_m": [14.546274124401856, 1]}	[]	1579478400000000
ace	depth-2	1579475400000000	14	{"depth_m": [14.607767350858873, 1]}	[]	1579478400000000
ace	depth-2	1579476000000000	15	{"depth_m": [14.567081190982366, 1]}	[]	1579478400000000
ace	depth-2	1579476600000000	16	{"depth_m": [14.583855872893047, 1]}	[]	1579478400000000
ace	depth-2	1579477200000000	17	{"depth_m": [14.653078354109644, 1]}	[]	1579478400000000
ace	depth-2	1579477800000000	18	{"depth_m": [14.581475571941588, 1]}	[]	1579478400000000
ace	depth-3	1579467600000000	1	{"depth_m": [28.528647325566972, 1]}	[]	1579478400000000
ace	depth-3	1579468200000000	2	{"depth_m": [28.666535959428124, 1]}	[]	1579478400000000
ace	depth-3	1579468800000000	3	{"depth_m": [28.764146333531123, 1]}	[]	1579478400000000
ace	depth-3	1579469400000000	4	{"depth_m": [28.90662801865821, 1]}	[]	1579478400000000
ace	depth-3	1579470000000000	5	{"depth_m": [28.985932690530895, 1]}	[]	1579478400000000
ace	depth-3	1579470600000000	6	{"depth_m": [29.173417521127636, 1]}	[]	1579478400000000
ace	depth-3	1579471200000000	7	{"depth_m": [29.313919830196088, 1]}	[]	1579478400000000
ace	depth-3	1579471800000000	8	{"depth_m": [29.53320035509576, 1]}	[]	1579478400000000
ace	depth-3	1579472400000000	9	{"depth_m": [29.531147419885073, 1]}	[]	1579478400000000
ace	depth-3	1579473000000000	10	{"depth_m": [29.682295649955485, 1]}	[]	1579478400000000
ace	depth-3	1579473600000000	11	{"depth_m": [29.767105594657124, 1]}	[]	1579478400000000
ace	depth-3	1579474200000000	12	{"depth_m": [29.814293670991667, 1]}	[]	1579478400000000
ace	depth-3	1579474800000000	13	{"depth_m": [29.9434095834144, 1]}	[]	1579478400000000
ace	depth-3	1579475400000000	14	{"depth_m": [29.99655065523485, 1]}	[]	1579478400000000
ace	depth-3	1579476000000000	15	{"depth_m": [30.000378104755608, 1]}	[]	1579478400000000
ace	depth-3	1579476600000000	16	{"depth_m": [30.0112380953981, 1]}	[]	1579478400000000
ace	depth-3	1579477200000000	17	{"depth_m": [30.107634296138063, 1]}	[]	1579478400000000
ace	depth-3	1579477800000000	18	{"depth_m": [30.08357384392988, 1]}	[]	1579478400000000
ace	shackle-1	1579467600000000	1	{"tension_kn": [8.476391323336856, 1]}	[]	1579478400000000
ace	shackle-1	1579468200000000	2	{"tension_kn": [9.24705940506915, 1]}	[]	1579478400000000
ace	shackle-1	1579468800000000	3	{"tension_kn": [9.714637295973263, 1]}	[]	1579478400000000
ace	shackle-1	1579469400000000	4	{"tension_kn": [10.148019714134364, 1]}	[]	1579478400000000
ace	shackle-1	1579470000000000	5	{"tension_kn": [10.676164827361703, 1]}	[]	1579478400000000
ace	shackle-1	1579470600000000	6	{"tension_kn": [11.086606375491874, 1]}	[]	1579478400000000
ace	shackle-1	1579471200000000	7	{"tension_kn": [10.975295106058223, 1]}	[]	1579478400000000
ace	shackle-1	1579471800000000	8	{"tension_kn": [11.381296990156754, 1]}	[]	1579478400000000
ace	shackle-1	1579472400000000	9	{"tension_kn": [11.730175511324314, 1]}	[]	1579478400000000
ace	shackle-1	1579473000000000	10	{"tension_kn": [11.537175719058737, 1]}	[]	1579478400000000
ace	shackle-1	1579473600000000	11	{"tension_kn": [11.61161002468223, 1]}	[]	1579478400000000
ace	shackle-1	1579474200000000	12	{"tension_kn": [11.784217940217829, 1]}	[]	1579478400000000
ace	shackle-1	1579474800000000	13	{"tension_kn": [11.628582009788815, 1]}	[]	1579478400000000
ace	shackle-1	1579475400000000	14	{"tension_kn": [11.798468426726258, 1]}	[]	1579478400000000
ace	shackle-1	1579476000000000	15	{"tension_kn": [11.495535896540481, 1]}	[]	1579478400000000
ace	shackle-1	1579476600000000	16	{"tension_kn": [11.553669515815876, 1]}	[]	1579478400000000
ace	shackle-1	1579477200000000	17	{"tension_kn": [11.754935940856821, 1]}	[]	1579478400000000
ace	shackle-1	1579477800000000	18	{"tension_kn": [11.437721144025621, 1]}	[]	1579478400000000
ace	shackle-2	1579467600000000	1	{"tension_kn": [0.5436109132883078, 1]}	[]	1579478400000000
ace	shackle-2	1579468200000000	2	{"tension_kn": [0.2629883741234257, 1]}	[]	1579478400000000
ace	shackle-2	1579468800000000	3	{"tension_kn": [0.5860632227434742, 1]}	[]	1579478400000000
ace	shackle-2	1579469400000000	4	{"tension_kn": [0.556862790869454, 1]}	[]	1579478400000000
ace	shackle-2	1579470000000000	5	{"tension_kn": [0.8769492029596971, 1]}	[]	1579478400000000
ace	shackle-2	1579470600000000	6	{"tension_kn": [1.0227772828090493, 1]}	[]	1579478400000000
ace	shackle-2	1579471200000000	7	{"tension_kn": [1.128869101764737, 1]}	[]	1579478400000000
ace	shackle-2	1579471800000000	8	{"tension_kn": [1.306837823237354, 1]}	[]	1579478400000000
ace	shackle-2	1579472400000000	9	{"tension_kn": [1.5819083496915547, 1]}	[]	1579478400000000
ace	shackle-2	1579473000000000	10	{"tension_kn": [1.913276238891746, 1]}	[]	1579478400000000
ace	shackle-2	1579473600000000	11	{"tension_kn": [2.1247844575199393, 1]}	[]	1579478400000000
ace	shackle-2	1579474200000000	12	{"tension_kn": [2.4852120833590017, 1]}	[]	1579478400000000
ace	shackle-2	1579474800000000	13	{"tension_kn": [2.8245987301648348, 1]}	[]	1579478400000000
ace	shackle-2	1579475400000000	14	{"tension_kn": [3.148630940988957, 1]}	[]	1579478400000000
ace	shackle-2	1579476000000000	15	{"tension_kn": [3.852316691467382, 1]}	[]	1579478400000000
ace	shackle-2	1579476600000000	16	{"tension_kn": [3.905569090028484, 1]}	[]	1579478400000000
ace	shackle-2	1579477200000000	17	{"tension_kn": [4.699596471406622, 1]}	[]	1579478400000000
ace	shackle-2	1579477800000000	18	{"tension_kn": [5.026161092630065, 1]}	[]	1579478400000000
ace	shackle-3	1579467600000000	1	{"tension_kn": [0.3470260135164491, 1]}	[]	1579478400000000
ace	shackle-3	1579468200000000	2	{"tension_kn": [0.7984593390046404, 1]}	[]	1579478400000000
ace	shackle-3	1579468800000000	3	{"tension_kn": [0.6915768377456689, 1]}	[]	1579478400000000
ace	shackle-3	1579469400000000	4	{"tension_kn": [0.6053760553183802, 1]}	[]	1579478400000000
ace	shackle-3	1579470000000000	5	{"tension_kn": [0.891442437667215, 1]}	[]	1579478400000000
ace	shackle-3	1579470600000000	6	{"tension_kn": [1.1520621087668044, 1]}	[]	1579478400000000
ace	shackle-3	1579471200000000	7	{"tension_kn": [1.4528897478035518, 1]}	[]	1579478400000000
ace	shackle-3	1579471800000000	8	{"tension_kn": [1.519258442666176, 1]}	[]	1579478400000000
ace	shackle-3	1579472400000000	9	{"tension_kn": [2.034422545844231, 1]}	[]	1579478400000000
ace	shackle-3	1579473000000000	10	{"tension_kn": [2.573905170094087, 1]}	[]	1579478400000000
ace	shackle-3	1579473600000000	11	{"tension_kn": [2.8128531184343606, 1]}	[]	1579478400000000
ace	shackle-3	1579474200000000	12	{"tension_kn": [3.5182246147857232, 1]}	[]	1579478400000000
ace	shackle-3	1579474800000000	13	{"tension_kn": [4.0528224147259815, 1]}	[]	1579478400000000
ace	shackle-3	1579475400000000	14	{"tension_kn": [4.656777811070383, 1]}	[]	1579478400000000
ace	shackle-3	1579476000000000	15	{"tension_kn": [5.200273227062783, 1]}	[]	1579478400000000
ace	shackle-3	1579476600000000	16	{"tension_kn": [5.51997232886083, 1]}	[]	1579478400000000
ace	shackle-3	1579477200000000	17	{"tension_kn": [6.071817116973806, 1]}	[]	1579478400000000
ace	shackle-3	1579477800000000	18	{"tension_kn": [6.623992851518774, 1]}	[]	1579478400000000
ace	shackle-4	1579467600000000	1	{"tension_kn": [0.46452253717368025, 1]}	[]	1579478400000000
ace	shackle-4	1579468200000000	2	{"tension_kn": [0.3702184027977501, 1]}	[]	1579478400000000
ace	shackle-4	1579468800000000	3	{"tension_kn": [0.6747152671810345, 1]}	[]	1579478400000000
ace	shackle-4	1579469400000000	4	{"tension_kn": [0.8459945546518438, 1]}	[]	1579478400000000
ace	shackle-4	1579470000000000	5	{"tension_kn": [0.6452146732743781, 1]}	[]	1579478400000000
ace	shackle-4	1579470600000000	6	{"tension_kn": [1.0808499944663748, 1]}	[]	1579478400000000
ace	shackle-4	1579471200000000	7	{"tension_kn": [1.4959882665883912, 1]}	[]	1579478400000000
ace	shackle-4	1579471800000000	8	{"tension_kn": [1.8011173963304392, 1]}	[]	1579478400000000
ace	shackle-4	1579472400000000	9	{"tension_kn": [2.0956090827549416, 1]}	[]	1579478400000000
ace	shackle-4	1579473000000000	10	{"tension_kn": [2.5383522138486336, 1]}	[]	1579478400000000
ace	shackle-4	1579473600000000	11	{"tension_kn": [3.3409189931159373, 1]}	[]	1579478400000000
ace	shackle-4	1579474200000000	12	{"tension_kn": [3.4490774822583337, 1]}	[]	1579478400000000
ace	shackle-4	1579474800000000	13	{"tension_kn": [4.148087078027586, 1]}	[]	1579478400000000
ace	shackle-4	1579475400000000	14	{"tension_kn": [4.334724067578204, 1]}	[]	1579478400000000
ace	shackle-4	1579476000000000	15	{"tension_kn": [5.0797012832407065, 1]}	[]	1579478400000000
ace	shackle-4	1579476600000000	16	{"tension_kn": [5.650658881369473, 1]}	[]	1579478400000000
ace	shackle-4	1579477200000000	17	{"tension_kn": [5.939807297703124, 1]}	[]	1579478400000000
ace	shackle-4	1579477800000000	18	{"tension_kn": [6.399692679669094, 1]}	[]	1579478400000000
ace	shackle-5	1579467600000000	1	{"tension_kn": [9.462466967283472, 1]}	[]	1579478400000000
ace	shackle-5	1579468200000000	2	{"tension_kn": [8.737052076620824, 1]}	[]	1579478400000000
ace	shackle-5	1579468800000000	3	{"tension_kn": [7.856520290338858, 1]}	[]	1579478400000000
ace	shackle-5	1579469400000000	4	{"tension_kn": [7.182004942935911, 1]}	[]	1579478400000000
ace	shackle-5	1579470000000000	5	{"tension_kn": [6.477988785703101, 1]}	[]	1579478400000000
ace	shackle-5	1579470600000000	6	{"tension_kn": [5.706459699985428, 1]}	[]	1579478400000000
ace	shackle-5	1579471200000000	7	{"tension_kn": [5.166266684077827, 1]}	[]	1579478400000000
ace	shackle-5	1579471800000000	8	{"tension_kn": [4.567051066606301, 1]}	[]	1579478400000000
ace	shackle-5	1579472400000000	9	{"tension_kn": [4.538607414590101, 1]}	[]	1579478400000000
ace	shackle-5	1579473000000000	10	{"tension_kn": [3.97599629758728, 1]}	[]	1579478400000000
ace	shackle-5	1579473600000000	11	{"tension_kn": [3.896186185638129, 1]}	[]	1579478400000000
ace	shackle-5	1579474200000000	12	{"tension_kn": [3.852518148927449, 1]}	[]	1579478400000000
ace	shackle-5	1579474800000000	13	{"tension_kn": [3.4558841999358325, 1]}	[]	1579478400000000
ace	shackle-5	1579475400000000	14	{"tension_kn": [3.0782434002282386, 1]}	[]	1579478400000000
ace	shackle-5	1579476000000000	15	{"tension_kn": [3.028647676351789, 1]}	[]	1579478400000000
ace	shackle-5	1579476600000000	16	{"tension_kn": [3.032705989532238, 1]}	[]	1579478400000000
ace	shackle-5	1579477200000000	17	{"tension_kn": [3.2006007749401295, 1]}	[]	1579478400000000
ace	shackle-5	1579477800000000	18	{"tension_kn": [2.886016724608934, 1]}	[]	1579478400000000
\.


--
-- Data for Name: sealed; Type: TABLE DATA; Schema: frozen_0_1_0; Owner: -
--

COPY frozen_0_1_0.sealed (cage, stream, t) FROM stdin;
\.


--
-- Data for Name: trial; Type: TABLE DATA; Schema: frozen_0_1_0; Owner: -
--

COPY frozen_0_1_0.trial (id, t) FROM stdin;
\.


--
-- Name: journal_number_seq; Type: SEQUENCE SET; Schema: frozen_0_1_0; Owner: -
--

SELECT pg_catalog.setval('frozen_0_1_0.journal_number_seq', 1, false);


--
-- Name: adapted adapted_pkey; Type: CONSTRAINT; Schema: frozen_0_1_0; Owner: -
--

ALTER TABLE ONLY frozen_0_1_0.adapted
    ADD CONSTRAINT adapted_pkey PRIMARY KEY (cage);


--
-- Name: aggregate aggregate_pkey; Type: CONSTRAINT; Schema: frozen_0_1_0; Owner: -
--

ALTER TABLE ONLY frozen_0_1_0.aggregate
    ADD CONSTRAINT aggregate_pkey PRIMARY KEY (cage, stream, quantity, width, t);


--
-- Name: alarm_book alarm_book_pkey; Type: CONSTRAINT; Schema: frozen_0_1_0; Owner: -
--

ALTER TABLE ONLY frozen_0_1_0.alarm_book
    ADD CONSTRAINT alarm_book_pkey PRIMARY KEY (cage);


--
-- Name: journal journal_pkey; Type: CONSTRAINT; Schema: frozen_0_1_0; Owner: -
--

ALTER TABLE ONLY frozen_0_1_0.journal
    ADD CONSTRAINT journal_pkey PRIMARY KEY (number);


--
-- Name: mark mark_pkey; Type: CONSTRAINT; Schema: frozen_0_1_0; Owner: -
--

ALTER TABLE ONLY frozen_0_1_0.mark
    ADD CONSTRAINT mark_pkey PRIMARY KEY (cage, stream, t);


--
-- Name: sample sample_pkey; Type: CONSTRAINT; Schema: frozen_0_1_0; Owner: -
--

ALTER TABLE ONLY frozen_0_1_0.sample
    ADD CONSTRAINT sample_pkey PRIMARY KEY (cage, stream, t, seq);


--
-- Name: sample_2020_01 sample_2020_01_pkey; Type: CONSTRAINT; Schema: frozen_0_1_0; Owner: -
--

ALTER TABLE ONLY frozen_0_1_0.sample_2020_01
    ADD CONSTRAINT sample_2020_01_pkey PRIMARY KEY (cage, stream, t, seq);


--
-- Name: sealed sealed_pkey; Type: CONSTRAINT; Schema: frozen_0_1_0; Owner: -
--

ALTER TABLE ONLY frozen_0_1_0.sealed
    ADD CONSTRAINT sealed_pkey PRIMARY KEY (cage, stream, t);


--
-- Name: trial trial_pkey; Type: CONSTRAINT; Schema: frozen_0_1_0; Owner: -
--

ALTER TABLE ONLY frozen_0_1_0.trial
    ADD CONSTRAINT trial_pkey PRIMARY KEY (id);


--
-- Name: journal_t; Type: INDEX; Schema: frozen_0_1_0; Owner: -
--

CREATE INDEX journal_t ON frozen_0_1_0.journal USING btree (cage, t, number);


--
-- Name: mark_touched; Type: INDEX; Schema: frozen_0_1_0; Owner: -
--

CREATE INDEX mark_touched ON frozen_0_1_0.mark USING btree (touched);


--
-- Name: sample_t; Type: INDEX; Schema: frozen_0_1_0; Owner: -
--

CREATE INDEX sample_t ON ONLY frozen_0_1_0.sample USING brin (t);


--
-- Name: sample_2020_01_t_idx; Type: INDEX; Schema: frozen_0_1_0; Owner: -
--

CREATE INDEX sample_2020_01_t_idx ON frozen_0_1_0.sample_2020_01 USING brin (t);


--
-- Name: sample_2020_01_pkey; Type: INDEX ATTACH; Schema: frozen_0_1_0; Owner: -
--

ALTER INDEX frozen_0_1_0.sample_pkey ATTACH PARTITION frozen_0_1_0.sample_2020_01_pkey;


--
-- Name: sample_2020_01_t_idx; Type: INDEX ATTACH; Schema: frozen_0_1_0; Owner: -
--

ALTER INDEX frozen_0_1_0.sample_t ATTACH PARTITION frozen_0_1_0.sample_2020_01_t_idx;


--
-- PostgreSQL database dump complete
--

\unrestrict 8C1d06yn7Ib8Ebv04hcpRdChFhs4esXBb6htacjDqkYzuyehjDLreGe4EVMsMzQ

